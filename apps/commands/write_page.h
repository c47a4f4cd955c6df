#pragma once

#include <string>

namespace softforce::apps {

// Before long work: throws InputError unless `file` could be written and is called like a page,
// .html, so that no input is written over by a slip.
void CheckCanWritePage(const std::string& file);

// Writes the page, and says so.
void WritePage(const std::string& file, const std::string& html);

}  // namespace softforce::apps
