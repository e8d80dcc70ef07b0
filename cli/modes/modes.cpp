#include "analysis/modes/modes.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/common/vtu_file.hpp"
#include "analysis/modes/complex_modes.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/model_options.hpp"
#include "cli/common/options.hpp"
#include "cli/common/solver_option.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/compare/compare_report.hpp"
#include "cli/modes/complex_tables.hpp"
#include "cli/modes/modes_tables.hpp"
#include "fe/linear/petsc.hpp"
#include "formats/hdf5/complex_modes_file.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

namespace {

struct ModesOptions : CommonOptions {
  analysis::ModesRequest request;
  std::string vtu, compare;
  analysis::ListingFiles listing;
};

/// "boom.h5" is "boom-subcase-2.h5" for a subcase after the first.
std::string name_output(const std::string& path, int subcase, bool is_first) {
  if (path.empty() || is_first) return path;
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + fmt::format("-subcase-{}", subcase) + p.extension().string()))
      .string();
}

/// Tables, JSON, files and pictures of the subcases.
class ModesOutput final : public analysis::ModesReceiver {
 public:
  ModesOutput(const ModesOptions& options, const Console& console) : options_(options), console_(console) {}

  void begin(std::size_t num_subcases, bool is_complex) override {
    has_several_ = num_subcases > 1;
    is_complex_ = is_complex;
    if (!is_complex) return;
    analysis::refuse_complex_option(!options_.listing.op2.empty(), "--op2");
    analysis::refuse_complex_option(!options_.compare.empty(), "--compare");
  }

  void take(analysis::SubcaseModes& modes, Diagnostics& diagnostics) override {
    const auto& result = modes.result;
    const bool is_buckling = options_.request.eigen.buckling;
    const auto vtu = add_picture(
        result.subcase, [&] { return exports::make_picture(result); }, diagnostics);
    add_heading(result.subcase);
    if (is_buckling) text_ += modes.load + "\n\n";
    text_ += (is_buckling ? format_buckling(result) : format_modes(result)) + "\n" +
             format_health(result, modes.solvers, modes.norm, is_buckling) +
             format_residual_vectors(result, modes.residual_loads, modes.unused_loads);
    text_ += format_effective_mass_about(result) + format_energies(result);
    auto one = make_json(result, modes.solvers, modes.norm, is_buckling);
    if (modes.sensitivities) {
      text_ += format_sensitivities(*modes.sensitivities);
      one["sensitivities"] = make_json(*modes.sensitivities);
    }
    if (!modes.residual_loads.empty())
      one["residual_vectors"] = {{"loads", modes.residual_loads}, {"unused", modes.unused_loads}};
    if (!options_.compare.empty() && console_.is_root()) {
      Diagnostics of_other;
      const auto pair = analysis::compare_models(options_.request.deck, modal::ModalModel::from(result),
                                                 options_.compare, analysis::load_model(options_.compare, of_other));
      if (is_first_) console_.print(of_other);
      text_ += "\n" + format_report(pair);
      one["comparison"] = make_json(pair);
    }
    add_json(std::move(one));
    write(result.subcase, vtu, [&](const std::string& path) { hdf5::write_modes(result, path); });
  }

  void take(records::ComplexModesResult& modes, Diagnostics& diagnostics) override {
    const auto vtu = add_picture(
        modes.subcase, [&] { return exports::make_picture(modes); }, diagnostics);
    add_heading(modes.subcase);
    text_ += format_complex_modes(modes);
    add_json(make_json(modes));
    write(modes.subcase, vtu, [&](const std::string& path) { hdf5::write_complex_modes(modes, path); });
  }

  /// Prints tables or JSON; writes pictures and listings.
  void finish(const analysis::ModesAnswer& answer) {
    if (!answer.failures.is_empty()) json_["failed"] = to_json(answer.failures);
    if (options_.json)
      console_.print_data(json_.dump(2) + "\n");
    else
      console_.print(text_);
    analysis::do_once([&] {
      for (const auto& [path, picture] : pictures_) analysis::write_text_file(path, picture);
      if (answer.listing) analysis::write_listings(options_.listing, *answer.listing);
      if (is_complex_) analysis::write_complex_listing(options_.listing, answer.complex_listing);
    });
    for (const auto& path : {options_.listing.f06, options_.listing.op2})
      if (!path.empty()) written_ += "written: " + path + "\n";
    for (const auto& [path, picture] : pictures_) written_ += "written: " + path + "\n";
    if (!options_.json) console_.print(written_);
    // A rank that ends with an error ends the others: the first one must be through.
    analysis::do_once([] { flush_data(); });
  }

 private:
  /// Returns the file of the picture; empty without one.
  template <class MakePicture>
  std::string add_picture(int subcase, const MakePicture& make_picture, Diagnostics& diagnostics) {
    const auto path = name_output(options_.vtu, subcase, is_first_);
    if (!path.empty() && console_.is_root())
      pictures_.emplace_back(path, analysis::make_vtu_text(make_picture(), exports::VtuEncoding::Base64,
                                                           options_.request.deck, diagnostics));
    return path;
  }

  void add_heading(int subcase) {
    if (has_several_) text_ += fmt::format("{}subcase {}\n\n", is_first_ ? "" : "\n", subcase);
  }

  void add_json(nlohmann::json one) {
    if (is_first_) json_ = one;
    if (has_several_) json_["subcases"].push_back(std::move(one));
  }

  template <class Write>
  void write(int subcase, const std::string& vtu, const Write& write_file) {
    const auto output = name_output(options_.output, subcase, is_first_);
    is_first_ = false;
    if (output.empty()) return;
    analysis::do_once([&] {
      check_outputs(options_, {output, options_.vtu, vtu == options_.vtu ? "" : vtu}, {options_.request.deck});
      write_file(output);
    });
    written_ += "written: " + output + "\n";
  }

  const ModesOptions& options_;
  const Console& console_;
  bool has_several_ = false, is_complex_ = false, is_first_ = true;
  nlohmann::json json_;
  std::string text_, written_;
  std::vector<std::pair<std::string, std::string>> pictures_;  ///< file, text
};

int run_modes(const ModesOptions& options) {
  Console console(options.quiet, options.verbosity);
  auto request = options.request;
  open_deck(console, options, request.deck, {options.output, options.vtu, options.listing.f06, options.listing.op2},
            {options.compare});
  if (!options.compare.empty()) analysis::do_once([&] { analysis::demand_file(options.compare); });
  request.has_shapes = !options.output.empty() || !options.vtu.empty() || !options.compare.empty();
  request.has_listing = !options.listing.empty();
  ModesOutput output(options, console);
  ConsoleEvents events(console);
  const auto answer = analysis::solve_modes(request, output, events);
  console.print(events.get_messages());
  console.print(answer.failures.get_items(events.get_messages()));
  output.finish(answer);
  return answer.failures.get_exit_code();
}

}  // namespace

void add_modes(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_modes, "modes", &analysis::ModesRequest::deck);
  verb->add_option("deck", o->request.deck, "Nastran deck")->required();
  verb->add_option("-n,--number,--modes", o->request.eigen.number,
                   "Number of modes (default: the deck's EIGRL or EIGC, else 10)")
      ->check(make_positive());
  verb->add_option("--min-hz", o->request.eigen.min_hz, "Lowest frequency wanted (with --buckling: load factor)")
      ->check(make_finite());
  verb->add_option("--max-hz", o->request.eigen.max_hz, "Highest frequency wanted (with --buckling: load factor)")
      ->check(make_finite());
  auto* buckling = verb->add_flag("--buckling", o->request.eigen.buckling,
                                  "Load factors of the static subcase instead of normal modes");
  verb->add_flag("--no-check", o->request.eigen.no_check,
                 "Leave out the count of eigenvalues that proves that no mode was missed");
  add_solver_option(*verb, o->request.eigen.solver);
  verb->add_flag("--ese,--energies", o->request.energies,
                 "Strain and kinetic energy of elements and properties in each mode: table, HDF5, VTU")
      ->excludes(buckling);
  verb->add_flag("--sensitivities", o->request.sensitivities,
                 "Derivatives of the eigenvalues with respect to the DESVAR of a deck of SOL 200")
      ->excludes(buckling);
  verb->add_option("--meffmass", o->request.about_grid, "Effective masses in units of mass, about this grid")
      ->excludes(buckling)
      ->check(make_positive());
  verb->add_option("--compare", o->compare, "Modes file or flexible body: the modes side by side with it, with MAC");
  verb->add_option("--vtu", o->vtu, "Write the mode shapes to this file for ParaView");
  add_listing_options(*verb, o->listing);
  verb->get_option("--op2")->excludes(buckling);
  add_model_options(*verb, o->request.model);
  add_common_options(*verb, *o, kOutput | kJson, "Write the modes to this HDF5 file");
}

}  // namespace bough::cli
