// libFuzzer on one reader: BOUGH_FUZZ_TARGET names it. Readers read files, so that each input becomes one.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/fuzz/looker.hpp"
#include "tests/fuzz/targets.hpp"

namespace {

const bough::fuzz::Target* g_target = nullptr;
std::string g_path;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("BOUGH_FUZZ_TARGET");
  g_target = bough::fuzz::find_target(name ? name : "");
  if (!g_target) {
    std::fprintf(stderr, "BOUGH_FUZZ_TARGET is to be one of");
    for (const auto& target : bough::fuzz::get_targets()) std::fprintf(stderr, " %s", target.name);
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  const char* folder = std::getenv("BOUGH_FUZZ_FOLDER");
  g_path = std::string(folder ? folder : "/tmp") + "/bough-fuzz-" + std::to_string(::getpid());
  // The library's memory, half a megabyte for each file that is opened, is not what is looked at: it keeps it.
  H5set_free_list_limits(-1, -1, -1, -1, -1, -1);
  bough::set_isolated_runner(bough::fuzz::work_by_one_process);
  std::atexit([] { ::unlink(g_path.c_str()); });
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::FILE* file = std::fopen(g_path.c_str(), "wb");
  if (!file) std::abort();
  std::fwrite(data, 1, size, file);
  std::fclose(file);
  // Files of the last seconds may still be written, and are waited for; each input is another state of the file.
  static std::time_t age = 0;
  const timespec times[2] = {{++age, 0}, {age, 0}};
  ::utimensat(AT_FDCWD, g_path.c_str(), times, 0);
  g_target->read(g_path);
  return 0;
}
