#include "cli/check/try_reduction.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>

#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/common/subcase_failures.hpp"
#include "cli/common/system_files.hpp"
#include "cli/reduce/reduce_body.hpp"

namespace bough::cli {

namespace {

/// Free dofs up to which a body is reduced to see whether it can be, these times modes, and bytes of matrices given.
constexpr int kMostDofs = 6000;
constexpr double kMostNumbers = 1e6;
constexpr std::uintmax_t kMostBytes = 20'000'000;

}  // namespace

void try_reduction(const std::string& file, records::BodySpec spec, int num_free_dofs, Diagnostics& diagnostics) {
  std::uintmax_t size = 0;
  if (spec.matrices)
    for (const auto& name : {spec.matrices->file, spec.matrices->stiffness.file, spec.matrices->mass.file}) {
      std::error_code failed;
      const auto bytes = std::filesystem::file_size(name, failed);
      if (!failed) size += bytes;
    }
  const bool is_large = num_free_dofs > kMostDofs || 1.0 * num_free_dofs * spec.num_modes > kMostNumbers;
  if (is_large || size > kMostBytes) {
    const auto what = is_large ? fmt::format("{} free dofs and {} modes", num_free_dofs, spec.num_modes)
                               : fmt::format("matrices of {} MB", size / 1'000'000);
    diagnostics.note("cli.not-reduced", {file}, "with " + what + " check does not try to reduce the body",
                     "a mechanism within it, or modes that do not exist, are found by reduce");
    return;
  }
  if (!spec.deck.empty()) spec.deck = resolve_beside(file, spec.deck);
  Diagnostics said;
  try {
    blame(file, [&] {
      reduce_body(spec, {}, said);
      return kSuccess;
    });
  } catch (const Failure& failure) {
    Diagnostics own;
    for (const auto& item : failure.items()) own.add(item);
    add_new(own, diagnostics);
  }
  add_new(said, diagnostics);
}

}  // namespace bough::cli
