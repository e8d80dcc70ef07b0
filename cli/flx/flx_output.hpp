#pragma once
/// \file Options and steps that `flx` and `integrals` share.
#include "cli/common/options.hpp"
#include "formats/flx/flx_file.hpp"

namespace bough::cli {

struct FlxOptions : CommonOptions {
  std::string layout;
  int digits = 9;
};

/// --layout and --digits.
void add_flx_options(CLI::App& verb, FlxOptions& options);

/// The template of --layout, or Bough's own with the given number of digits.
flx::Layout choose_layout(const FlxOptions& options, int digits);

/// Every block by name, as `flx --read --json` prints it; arrays as in the flexible-body file. Of several bodies a list
/// named bodies.
std::string format_flx_json(const std::vector<flx::FlxFile>& files);
/// Text tables of the contents of a file.
std::string format_flx_text(const flx::FlxFile& file);

}  // namespace bough::cli
