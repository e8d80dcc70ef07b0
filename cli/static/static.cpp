#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/common/vtu_file.hpp"
#include "analysis/static/static.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/static/static_output.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::cli {

namespace {

struct StaticOptions : CommonOptions {
  analysis::StaticRequest request;
  std::string vtu;
  bool full = false, in_cd = false, has_extremes = false;
  analysis::ListingFiles listing;
};

StaticOutputOptions make_output_options(const StaticOptions& options, bool is_root) {
  StaticOutputOptions output_options;
  if (is_root) output_options.path = options.output;
  output_options.has_text = !options.quiet && !options.json;
  output_options.has_json = options.json;
  output_options.is_full = options.full;
  output_options.in_cd = options.in_cd;
  output_options.has_extremes = options.has_extremes;
  output_options.keeps = !options.vtu.empty();
  return output_options;
}

int run_static(const StaticOptions& options) {
  Console console(options.quiet, options.verbosity);
  auto request = options.request;
  open_deck(console, options, request.deck, {options.output, options.vtu, options.listing.f06, options.listing.op2});
  request.has_listing = !options.listing.empty();
  StaticOutput output(make_output_options(options, console.is_root()));
  ConsoleEvents events(console);
  const auto answer = analysis::solve_static(request, output, events);
  Diagnostics of_picture;
  std::string picture;
  if (!options.vtu.empty() && console.is_root())
    picture = analysis::make_vtu_text(exports::make_picture(output.get_result()), exports::VtuEncoding::Base64,
                                      request.deck, of_picture);
  analysis::add_messages(of_picture, events);
  console.print(events.get_messages());
  console.print(answer.failures.get_items(events.get_messages()));

  output.finish(answer.source);
  if (options.json) {
    nlohmann::json json{{"subcases", output.get_subcases()}};
    if (options.has_extremes) json["extremes"] = output.get_extremes();
    if (!answer.failures.is_empty()) json["failed"] = to_json(answer.failures);
    console.print_data(json.dump(2) + "\n");
  } else {
    console.print(output.get_text());
  }
  if (!picture.empty()) analysis::write_text_file(options.vtu, picture);
  if (answer.listing) analysis::do_once([&] { analysis::write_listings(options.listing, *answer.listing); });
  print_written_files(options, console, {options.output, options.vtu, options.listing.f06, options.listing.op2});
  // A rank that ends with an error ends the others: the first one must be through.
  analysis::do_once([] { flush_data(); });
  return answer.failures.get_exit_code();
}

}  // namespace

void add_static(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_static, "static", &analysis::StaticRequest::deck);
  verb->add_option("deck", o->request.deck, "Nastran deck")->required();
  verb->add_flag("--full", o->full, "Every grid and element instead of the largest values");
  verb->add_flag("--extremes,--maxmin", o->has_extremes,
                 "The least and the largest of each component over the subcases");
  verb->add_flag("--strains", o->request.has_strains,
                 "Strains of elements next to their stresses, as STRAIN of the deck");
  verb->add_flag("--cd", o->in_cd, "Print vectors in the displacement (CD) axes of each grid, not in basic");
  verb->add_flag("--linear", o->request.is_linear,
                 "Solve the cards linearly though SOL is nonlinear (106, 129, 400, ...)");
  verb->add_flag("--nonlinear", o->request.is_nonlinear,
                 "Large displacements and rotations, elastic materials; the way of SOL 106 with PARAM,LGDISP,1");
  verb->add_option("--increments", o->request.num_increments, "Load steps of each nonlinear subcase (default: 10)")
      ->check(is_within(1, 100000))
      ->each([options = o](const std::string&) { options->request.has_increments = true; });
  verb->add_flag("--arc-length", o->request.has_arc_length,
                 "Nonlinear subcases follow their path through limit points (snap-through)");
  verb->add_option("--vtu", o->vtu, "Write the displacements of every subcase to this file for ParaView");
  verb->add_option("--grid-forces", o->request.grid_forces,
                   "List every force on these grids, or on all: elements, loads, SPC")
      ->delimiter(',');
  add_listing_options(*verb, o->listing);
  add_model_options(*verb, o->request.model);
  add_common_options(*verb, *o, kOutput | kJson, "Write displacements, reactions and forces to this HDF5 file");
}

}  // namespace bough::cli
