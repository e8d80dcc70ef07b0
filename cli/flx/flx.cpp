#include "analysis/flx/flx.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "cli/common/console.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/flx/flx_output.hpp"
#include "formats/flx/fragment.hpp"

namespace bough::cli {

namespace {

struct FlxVerbOptions : FlxOptions {
  analysis::FlxRequest request;
  std::string read, fragment;
  int first_id = 1;
  bool digits_given = false;
};

void print_written(const FlxVerbOptions& o, const std::string& output, const Console& console) {
  const std::string both = output.empty() || o.fragment.empty() ? "" : " and ";
  console.print("written: " + output + both + o.fragment + "\n");
}

int run_read(const FlxVerbOptions& o, const Console& console) {
  const auto files = analysis::read_flx_files(o.read);
  check_outputs(o, {o.output, o.fragment}, {analysis::get_body_path(o.read), o.layout});
  if (!o.output.empty()) {
    std::string text;
    for (const auto& file : files)
      text += flx::write_flx(file, choose_layout(o, o.digits_given ? o.digits : file.digits));
    analysis::write_text_file(o.output, text);
  }
  if (!o.fragment.empty()) analysis::write_text_file(o.fragment, flx::make_fragment(files, o.first_id));
  if (o.json) {
    console.print_data(format_flx_json(files));
  } else if (o.output.empty() && o.fragment.empty()) {
    for (const auto& file : files) console.print_data(format_flx_text(file));
  } else {
    print_written(o, o.output, console);
  }
  return kSuccess;
}

int run_flx(const FlxVerbOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  if (o.request.bodies.empty() == o.read.empty()) {
    console.print_error("cli.usage", "give either a flexible body to write or --read FILE", "see bough flx --help");
    return kUsageError;
  }
  if (!o.read.empty()) return run_read(o, console);
  if (o.request.bodies.size() > 1 && o.output.empty()) {
    console.print_error("cli.usage", "several bodies go into one file: give it with -o", "see bough flx --help");
    return kUsageError;
  }
  analysis::choose_body_ids(o.request);
  auto inputs = o.request.bodies;
  for (const auto& name : o.request.bodies) analysis::demand_file(name);
  const std::string output =
      o.output.empty() ? std::filesystem::path(o.request.bodies.front()).stem().string() + ".FLX" : o.output;
  inputs.push_back(o.layout);
  check_outputs(o, {output, o.fragment}, inputs);
  const auto layout = choose_layout(o, o.digits);
  auto request = o.request;
  request.digits = o.digits;
  Diagnostics diagnostics;
  const auto files = analysis::make_flx_files(request, diagnostics);
  console.print(diagnostics);
  std::string text;
  for (const auto& file : files) text += flx::write_flx(file, layout);
  analysis::write_text_file(output, text);
  if (!o.fragment.empty()) analysis::write_text_file(o.fragment, flx::make_fragment(files, o.first_id));
  if (o.json)
    console.print_data(format_flx_json(files));
  else
    print_written(o, output, console);
  return kSuccess;
}

}  // namespace

void add_flx(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb<FlxVerbOptions>(app, "flx");
  verb->add_option("body", o->request.bodies, "Flexible-body files that bough reduce wrote; several go into one .FLX");
  verb->add_option("--read", o->read,
                   "Print this .FLX file block by block, of FILE.FLX:2 the body with the id 2; with -o write it again");
  verb->add_flag("--special-nodes", o->request.special_nodes,
                 "Add the nmode + 1 nodes through which a controller applies the geometric stiffness");
  verb->add_option("--integrals", o->request.integrals,
                   "Mass integrals: lumped, consistent or exact (default: the body's choice)")
      ->check(CLI::IsMember({"lumped", "consistent", "exact"}));
  verb->add_option("--modopt", o->request.modopt, "0 all integrals, 1 zero and first order, 2 zero order only")
      ->check(is_within(0, 2))
      ->capture_default_str();
  verb->add_option("--body-id", o->request.body_ids,
                   "Number of the body in the multibody model; of several the first, or one each: 3,7 (default: 1)")
      ->delimiter(',')
      ->check(make_positive());
  verb->add_flag("--stiffening", o->request.stiffening,
                 "Write K_G1, K_G2 and the preload too, in lines that readers of version 1.0 pass over: a run of Bough "
                 "then stiffens as from the HDF5 file");
  verb->add_option("--int", o->fragment,
                   "Also write what the .INT of TREETOPS needs for geometric stiffening, as a list to type in: special "
                   "nodes, jets, sensors, user controller");
  verb->add_option("--int-first", o->first_id, "--int: first number of the actuators, sensors and controllers")
      ->check(make_positive())
      ->capture_default_str();
  add_flx_options(*verb, *o);
  add_common_options(*verb, *o, kOutput | kJson, ".FLX file to write (default: the body file's name with .FLX, here)");
  verb->callback([&action, o = o, verb = verb] {
    o->digits_given = verb->count("--digits") > 0;
    action = [o] { return run_flx(*o); };
  });
}

}  // namespace bough::cli
