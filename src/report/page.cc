#include "report/page.h"

#include "report/format.h"
#include "report/page_style.h"

namespace softforce::report {

std::string Page(const std::string& title, const std::string& body, const std::string& scripts) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
         Escape(title) + "</title>\n<style>" + std::string(kPageStyle) +
         "</style>\n</head>\n<body>\n<main>\n" + body + "</main>\n" + scripts +
         "</body>\n</html>\n";
}

std::string Figure(const std::string& content, const std::string& caption) {
  return "<figure>" + content + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string Folded(const std::string& summary, const std::string& content) {
  return "<details class=\"box\"><summary>" + Escape(summary) + "</summary>" + content +
         "</details>\n";
}

std::string Card(const std::string& figure, const std::string& meaning) {
  return "<div class=\"card\"><b>" + Escape(figure) + "</b><span>" + Escape(meaning) +
         "</span></div>\n";
}

std::string Key(const std::string& css_class, const std::string& meaning) {
  return "<span class=\"entry\"><span class=\"key " + css_class + "\"></span>" + Escape(meaning) +
         "</span>";
}

}  // namespace softforce::report
