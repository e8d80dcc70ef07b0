#include "formats/flx/flx_file.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/common/console.hpp"
#include "cli/common/text_file.hpp"
#include "cli/flx/flx_output.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

namespace {

struct FlxVerbOptions : FlxOptions {
  std::string body, read, integrals;
  int body_id = 1, modopt = 0;
  bool special_nodes = false;
  bool digits_given = false;
};

int run_read(const FlxVerbOptions& o, const Console& console) {
  demand_file(o.read);
  const auto file = flx::read_flx(o.read);
  if (!o.output.empty()) {
    check_output(o, o.output, {o.read, o.layout});
    write_text_file(o.output, flx::write_flx(file, choose_layout(o, o.digits_given ? o.digits : file.digits)));
  }
  if (o.json)
    console.print_data(format_flx_json(file));
  else if (o.output.empty())
    console.print_data(format_flx_text(file));
  else
    console.print("written: " + o.output + "\n");
  return kSuccess;
}

int run_flx(const FlxVerbOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  if (o.body.empty() == o.read.empty()) {
    console.print_error("cli.usage", "give either a flexible body to write or --read FILE", "see bough flx --help");
    return kUsageError;
  }
  if (!o.read.empty()) return run_read(o, console);
  demand_file(o.body);
  const auto layout = choose_layout(o, o.digits);
  const auto body = hdf5::read_flex_body(o.body);
  flx::MakeOptions options;
  options.body_id = o.body_id;
  options.modopt = o.modopt;
  options.method = o.integrals;
  options.has_special_nodes = o.special_nodes;
  options.digits = o.digits;
  const auto file = flx::make_flx(body, options);
  const std::string output = o.output.empty() ? std::filesystem::path(o.body).stem().string() + ".FLX" : o.output;
  check_output(o, output, {o.body, o.layout});
  write_text_file(output, flx::write_flx(file, layout));
  if (o.json)
    console.print_data(format_flx_json(file));
  else
    console.print("written: " + output + "\n");
  return kSuccess;
}

}  // namespace

void add_flx(CLI::App& app, Action& action) {
  auto o = std::make_shared<FlxVerbOptions>();
  auto* verb = app.add_subcommand("flx", "A flexible body becomes a .FLX file for TREETOPS, or such a file is read");
  verb->add_option("body", o->body, "Flexible-body file that bough reduce wrote");
  verb->add_option("--read", o->read, "Print this .FLX file block by block; with -o write it again");
  verb->add_flag("--special-nodes", o->special_nodes,
                 "Add the nmode + 1 nodes through which a controller applies the geometric stiffness");
  verb->add_option("--integrals", o->integrals,
                   "Mass integrals: lumped, consistent or exact (default: the body's choice)")
      ->check(CLI::IsMember({"lumped", "consistent", "exact"}));
  verb->add_option("--modopt", o->modopt, "0 all integrals, 1 zero and first order, 2 zero order only")
      ->check(CLI::Range(0, 2))
      ->capture_default_str();
  verb->add_option("--body-id", o->body_id, "Number of the body in the multibody model")->capture_default_str();
  add_flx_options(*verb, *o);
  add_common_options(*verb, *o, kOutput | kJson, ".FLX file to write (default: the body file's name with .FLX, here)");
  verb->footer(
      "Example:\n  bough flx boom.h5 --special-nodes -o boom.FLX\n  bough flx boom.h5 --layout site.layout -o "
      "boom.FLX\n"
      "  bough flx --read boom.FLX --json");
  verb->callback([&action, o, verb] {
    o->digits_given = verb->count("--digits") > 0;
    action = [o] { return run_flx(*o); };
  });
}

}  // namespace bough::cli
