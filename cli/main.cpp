#include <unistd.h>

#include <cstdio>

#include "base/platform.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/memory_limit.hpp"
#include "cli/common/user_code.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/lost_file.hpp"

namespace {

/// Handles signals from the moment the program is loaded: its libraries take longer to start than some commands to run.
/// Not in the library of the commands, since a Python process that loads it keeps its own signals.
BOUGH_CALL_AT_LOAD(bough::cli::end_cleanly_on_signals)

}  // namespace

// Exported: a user library that ends the process without exit() binds to these instead of those of the C library.
extern "C" {
void _exit(int code) {
  bough::cli::end_if_in_user_code("_exit()");
  bough::cli::leave_at_once(code);
}
void _Exit(int code) noexcept {
  bough::cli::end_if_in_user_code("_Exit()");
  bough::cli::leave_at_once(code);
}
}

int main(int argc, char** argv) {
  bough::cli::leave_word_to_first_rank();
  bough::cli::prepare_for_memory_limit(argv);
  bough::cli::secure_streams();
  bough::cli::guard_user_code();
  const int code = bough::cli::run_command({argv + 1, argv + argc});
  if (bough::hdf5::has_lost_file()) {
    std::fflush(nullptr);
    ::_exit(code);
  }
  return code;
}
