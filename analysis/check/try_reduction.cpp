#include "analysis/check/try_reduction.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>

#include "analysis/common/failures.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/reduce/reduce_body.hpp"

namespace bough::analysis {

namespace {

/// Free dofs up to which a body is reduced to see whether it can be, these times modes, and bytes of matrices given.
constexpr int kMaxDofs = 6000;
constexpr double kMaxNumbers = 1e6;
constexpr std::uintmax_t kMaxBytes = 20'000'000;

}  // namespace

void try_reduction(const std::string& file, records::BodySpec spec, int num_free_dofs, Diagnostics& diagnostics) {
  std::uintmax_t size = 0;
  if (spec.matrices)
    for (const auto& name : {spec.matrices->file, spec.matrices->stiffness.file, spec.matrices->mass.file}) {
      std::error_code failed;
      const auto bytes = std::filesystem::file_size(name, failed);
      if (!failed) size += bytes;
    }
  const bool is_large = num_free_dofs > kMaxDofs || 1.0 * num_free_dofs * spec.num_modes > kMaxNumbers;
  if (is_large || size > kMaxBytes) {
    const auto what = is_large ? fmt::format("{} free dofs and {} modes", num_free_dofs, spec.num_modes)
                               : fmt::format("matrices of {} MB", size / 1'000'000);
    diagnostics.note("cli.not-reduced", {file}, "with " + what + " check does not try to reduce the body",
                     "a mechanism within it, or modes that do not exist, are found by reduce");
    return;
  }
  if (!spec.deck.empty()) spec.deck = resolve_beside(file, spec.deck);
  Diagnostics found;
  try {
    with_file(file, [&] {
      reduce_body(spec, {}, found);
      return 0;
    });
  } catch (const Failure& failure) {
    Diagnostics own;
    for (const auto& item : failure.items()) own.add(item);
    add_new(own, diagnostics);
  }
  add_new(found, diagnostics);
}

}  // namespace bough::analysis
