#include "formats/fmu/archive.hpp"

#include <zip.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "base/diagnostic.hpp"

namespace bough::fmu {

namespace fs = std::filesystem;

namespace {

constexpr zip_uint16_t kTime = 0, kDate = (0 << 9) | (1 << 5) | 1;  // MS-DOS: 1980-01-01 00:00
constexpr zip_uint32_t kCompression = 3;                            // of 9: half the time of 6, a twentieth larger
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
        zip_set_file_compression(archive, at, ZIP_CM_DEFLATE, kCompression) < 0 ||
        zip_file_set_external_attributes(archive, at, 0, ZIP_OPSYS_UNIX, entry.is_program ? kProgram : kFile) < 0)
      give_up();
  }
  if (zip_close(archive) < 0) give_up();
}

void extract_archive(const std::string& path, const std::string& folder) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30;  // of all files together: a zip bomb has more
  const auto refuse = [&](const std::string& what) {
    return InputError("fmu.bad-archive", {path}, "the FMU cannot be unpacked: " + what, "export the FMU again");
  };
  int code = 0;
  const std::unique_ptr<zip_t, void (*)(zip_t*)> archive(zip_open(path.c_str(), ZIP_RDONLY, &code), zip_discard);
  if (!archive) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw refuse(why);
  }
  std::uint64_t num_bytes = 0;
  std::vector<char> buffer(1 << 16);
  const auto n = static_cast<zip_uint64_t>(zip_get_num_entries(archive.get(), 0));
  for (zip_uint64_t i = 0; i < n; ++i) {
    const char* text = zip_get_name(archive.get(), i, 0);
    if (!text) throw refuse(zip_strerror(archive.get()));
    const std::string name = text;
    const fs::path relative = fs::path(name).lexically_normal();
    if (relative.is_absolute() || relative.empty() || *relative.begin() == "..")
      throw refuse("its entry '" + name + "' leads out of the folder");
    const fs::path to = fs::path(folder) / relative;
    std::error_code failed;
    fs::create_directories(name.ends_with('/') ? to : to.parent_path(), failed);
    if (name.ends_with('/')) continue;
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> entry(zip_fopen_index(archive.get(), i, 0), zip_fclose);
    if (!entry) throw refuse("'" + name + "': " + zip_strerror(archive.get()));
    std::ofstream file(to, std::ios::binary);
    for (;;) {
      const zip_int64_t got = zip_fread(entry.get(), buffer.data(), buffer.size());
      if (got < 0) throw refuse("'" + name + "' is damaged: " + zip_file_strerror(entry.get()));
      if (got == 0) break;
      if ((num_bytes += static_cast<std::uint64_t>(got)) > kMaxBytes) throw refuse("its files take more than 4 GiB");
      file.write(buffer.data(), got);
    }
    file.close();
    if (!file)
      throw ComputationError("fmu.unpack", {path}, "the FMU could not be unpacked into " + to.string(),
                             "check the space left, or choose another folder by TMPDIR");
  }
}

}  // namespace bough::fmu
