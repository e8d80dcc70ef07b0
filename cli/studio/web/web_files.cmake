# Writes web_files.cpp: the modules and styles that the studio serves, those of the report page among them.
# cmake -DREPORT=report/web -DSTUDIO=cli/studio/web -DOUTPUT=web_files.cpp -P web_files.cmake
file(GLOB files ${REPORT}/*.js ${REPORT}/*.css ${STUDIO}/*.js ${STUDIO}/*.css ${STUDIO}/*.html)
list(FILTER files EXCLUDE REGEX "/report/web/main\\.js$")
set(entries "")
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND entries "      {\"${name}\", R\"~~~(${text})~~~\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"cli/studio/web_files.hpp\"

namespace bough::cli {

const std::vector<WebFile>& get_web_files() {
  static const std::vector<WebFile> files{
${entries}  };
  return files;
}

}  // namespace bough::cli
")
