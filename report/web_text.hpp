#pragma once
/// \file The page's script and style, written into the program when it is built (web/web_text.cmake), and their hashes
/// as a Content-Security-Policy names them: "sha256-...".

namespace bough::report {

/// Returns the JavaScript of the page.
const char* get_script();
/// Returns the hash of get_script() for the policy.
const char* get_script_hash();
/// Returns the CSS of the page.
const char* get_style();
/// Returns the hash of get_style() for the policy.
const char* get_style_hash();

}  // namespace bough::report
