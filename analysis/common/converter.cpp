#include "analysis/common/converter.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/diagnostic.hpp"
#include "base/part_file.hpp"
#include "base/platform.hpp"

namespace bough::analysis {

void write_converted(const std::string& path, const std::string& text, const Converter& converter) {
  PartFile source(path), part(path);
  const auto fail = [&](const std::string& what, const std::string& advice) {
    return ComputationError("cli.write", {path}, what, advice);
  };
  const std::string look = "check the folder, its permissions and the space left";
  if (part.error() || !source.write(text.data(), text.size()))
    throw fail("the file could not be written: " + (part.error() ? part : source).error().message(), look);
  auto words = converter.make_arguments(source.get_name(), part.get_name());
  words.insert(words.begin(), converter.program);
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  const int failed =
      posix_spawnp(&child, words[0].c_str(), nullptr, nullptr, arguments.data(), platform::get_environment());
  const bool is_drawn = failed == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status);
  if (is_drawn && WEXITSTATUS(status) == 0 && part.commit()) return;
  // 127: some systems report a missing program only through the child.
  if (failed != 0 || !is_drawn || WEXITSTATUS(status) == 127)
    throw ComputationError("cli.no-converter", {path},
                           "the program " + converter.program + " is not there, or does not start",
                           "install " + converter.package + ", or " + converter.otherwise);
  throw fail(converter.program + " could not write the picture", look + ", or " + converter.otherwise);
}

}  // namespace bough::analysis
