#include "formats/fmu/archive.hpp"

#include <zip.h>

#include "base/diagnostic.hpp"

namespace bough::fmu {
namespace {

constexpr zip_uint16_t kTime = 0, kDate = (0 << 9) | (1 << 5) | 1;  // MS-DOS: 1980-01-01 00:00
constexpr zip_uint32_t kFile = 0100644u << 16, kProgram = 0100755u << 16;

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw ComputationError("fmu.write", {path}, "the FMU could not be written: " + why,
                         "check the folder, its permissions and the space left");
}

}  // namespace

void write_archive(const std::string& path, const std::vector<ArchiveEntry>& entries) {
  int code = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (!archive) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    fail(path, why);
  }
  const auto give_up = [&] {
    const std::string why = zip_strerror(archive);
    zip_discard(archive);
    fail(path, why);
  };
  for (const auto& entry : entries) {
    zip_source_t* source = zip_source_buffer(archive, entry.bytes.data(), entry.bytes.size(), 0);
    if (!source) give_up();
    const auto index = zip_file_add(archive, entry.name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      give_up();
    }
    const auto at = static_cast<zip_uint64_t>(index);
    if (zip_file_set_dostime(archive, at, kTime, kDate, 0) < 0 ||
        zip_set_file_compression(archive, at, ZIP_CM_DEFLATE, 6) < 0 ||
        zip_file_set_external_attributes(archive, at, 0, ZIP_OPSYS_UNIX, entry.is_program ? kProgram : kFile) < 0)
      give_up();
  }
  if (zip_close(archive) < 0) give_up();
}

}  // namespace bough::fmu
