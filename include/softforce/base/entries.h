#pragma once

#include <map>
#include <optional>
#include <string>

#include "softforce/base/quantity.h"

namespace softforce::base {

// What a user wrote as "key=value, key=value, flag": each entry is asked for once, and what is left
// over was a mistake. Spaces and the case of keys do not matter. Every error names `where` and ends
// with the advice.
class Entries {
 public:
  // Throws InputError if an entry is given twice.
  Entries(const std::string& text, std::string where, std::string advice);

  // Throw InputError if the entry is missing and there is no `otherwise`, has no value, or is not
  // of its kind. `otherwise` is read as if it had been written.
  std::string Take(const std::string& key, const std::string& otherwise = "");
  double TakeQuantity(const std::string& key, Dimension dimension,
                      const std::string& otherwise = "");                    // SI
  int TakeCount(const std::string& key, const std::string& otherwise = "");  // from 0 on
  bool TakeFlag(const std::string& key);  // "legacy", "legacy=true"; false if it is missing

  // Throws InputError if an entry has not been asked for; `known`: what there is, for a person.
  void RefuseRest(const std::string& known) const;

 private:
  std::string where_, advice_;
  std::map<std::string, std::optional<std::string>> values_;
};

// Without the spaces at both ends.
std::string Trimmed(const std::string& text);

// In small letters, of ASCII.
std::string LowerCase(std::string text);

}  // namespace softforce::base
