#include "cli/common/interrupt.hpp"
#include "cli/common/memory_limit.hpp"
#include "cli/verbs.hpp"

int main(int argc, char** argv) {
  bough::cli::prepare_for_memory_limit(argv);
  bough::cli::secure_streams();
  return bough::cli::run_command({argv + 1, argv + argc});
}
