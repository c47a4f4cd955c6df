#pragma once

#include <string>

namespace softforce::report {

// Pieces that all pages are made of. Captions and contents are HTML, titles and meanings texts.

// The whole document around `body`: one file that needs no other, and no network. `scripts` come
// last.
std::string Page(const std::string& title, const std::string& body,
                 const std::string& scripts = "");

std::string Figure(const std::string& content, const std::string& caption);
std::string Folded(const std::string& summary, const std::string& content);
std::string Card(const std::string& figure, const std::string& meaning);

// A patch of the colour of a style's class, and what it stands for.
std::string Key(const std::string& css_class, const std::string& meaning);

}  // namespace softforce::report
