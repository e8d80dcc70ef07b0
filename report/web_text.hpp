#pragma once
/// \file The page's script and style, written into the program when it is built (web/web_text.cmake), and their hashes
/// as a Content-Security-Policy names them: "sha256-...".

namespace bough::report {

const char* get_script();
const char* get_script_hash();
const char* get_style();
const char* get_style_hash();

}  // namespace bough::report
