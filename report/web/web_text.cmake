# Writes web_text.cpp: the modules of this folder joined to one script, the style, and the SHA-256 of both.
# cmake -DWEB=folder -DOUTPUT=web_text.cpp -P web_text.cmake
# Each module may import from those before it in this list; joined, they share one scope.
set(modules unpack page_parts numbers chart spectrum history drawing coarse_mesh picking viewer modes_view scene_marks motion_view linear_view spin_view chapter_views main)
set(script "\n")
foreach(module ${modules})
  file(READ ${WEB}/${module}.js text)
  string(REGEX REPLACE "(^|\n)import [^\n]*" "" text "${text}")
  string(REGEX REPLACE "\nexport " "\n" text "${text}")
  string(APPEND script "${text}")
endforeach()
file(READ ${WEB}/page.css style)

# "sha256-" and the digest in base64, as browsers compare it.
function(make_hash text result)
  string(SHA256 hex "${text}")
  set(digits "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")
  # 32 bytes: ten groups of three, and two bytes.
  set(hash "sha256-")
  foreach(at RANGE 0 54 6)
    string(SUBSTRING ${hex} ${at} 6 group)
    math(EXPR number "0x${group}")
    foreach(shift 18 12 6 0)
      math(EXPR digit "(${number} >> ${shift}) & 63")
      string(SUBSTRING ${digits} ${digit} 1 letter)
      string(APPEND hash ${letter})
    endforeach()
  endforeach()
  string(SUBSTRING ${hex} 60 4 group)
  math(EXPR number "0x${group} << 2")
  foreach(shift 12 6 0)
    math(EXPR digit "(${number} >> ${shift}) & 63")
    string(SUBSTRING ${digits} ${digit} 1 letter)
    string(APPEND hash ${letter})
  endforeach()
  set(${result} "${hash}=" PARENT_SCOPE)
endfunction()

make_hash("${script}" script_hash)
make_hash("${style}" style_hash)
file(WRITE ${OUTPUT} "#include \"report/web_text.hpp\"

namespace bough::report {

const char* get_script() { return R\"~~~(${script})~~~\"; }
const char* get_script_hash() { return \"${script_hash}\"; }
const char* get_style() { return R\"~~~(${style})~~~\"; }
const char* get_style_hash() { return \"${style_hash}\"; }

}  // namespace bough::report
")
