// Every file of tests/fuzz/corpus/TARGET through its reader: what fuzzing found once, and seeds.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "tests/fuzz/targets.hpp"

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  if (argc != 2) return std::fprintf(stderr, "usage: fuzz_replay CORPUS\n"), 2;
  int count = 0;
  for (const auto& target : bough::fuzz::get_targets()) {
    const fs::path folder = fs::path(argv[1]) / target.name;
    if (!fs::is_directory(folder)) return std::fprintf(stderr, "no folder %s\n", folder.c_str()), 1;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    if (files.empty()) return std::fprintf(stderr, "nothing in %s\n", folder.c_str()), 1;
    for (const auto& file : files) {
      std::printf("%s\n", file.c_str());
      std::fflush(stdout);
      target.read(file.string());
      ++count;
    }
  }
  std::printf("%d files read\n", count);
  return 0;
}
