#pragma once
/// \file Changes single values of a TOML text and leaves the rest as it is, comments too.
#include <functional>
#include <string>

#include "base/diagnostic.hpp"

namespace bough::toml_files {

/// Sets the value at a dotted path: "body.modes.number". An entry of a list is named by its number from 1, a table of a
/// list of tables by that or by its `name`: "hinge.spin.stiffness", "body.origin.2". A key that is absent is added to
/// its table. `value` is TOML text. Returns what is wrong, or empty.
std::string set_key(std::string& text, const std::string& path, const std::string& value);

/// Replaces every text value of the keys `deck` and `file`, [body.output] aside, by what `change` makes of it.
void change_file_keys(std::string& text, const std::function<std::string(const std::string&)>& change);

/// Checks a body or system file's text against its schema: the toml.* errors of it; `file` only names it.
void check_text(const std::string& text, const std::string& file, Diagnostics& diagnostics);

/// A TOML string that reads back as `text`.
std::string quote_text(const std::string& text);

}  // namespace bough::toml_files
