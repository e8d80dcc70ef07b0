#include "cli/convert/convert.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/convert/unit_system.hpp"
#include "formats/nastran/unit_conversion.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct ConvertOptions : CommonOptions {
  std::string file, units, from, to;
};

int run_convert(const ConvertOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  demand_deck(o.file);
  if (o.units.empty() && o.from.empty())
    throw InputError("cli.bad-units", {}, "the units are not given", "write --units mm-N-tonne:m-kg-s");
  const auto [from_name, to_name] = o.units.empty() ? std::pair{o.from, o.to} : split_units(o.units);
  const auto from = parse_units(from_name), to = parse_units(to_name);
  Diagnostics diagnostics;
  const nastran::DeckEditor deck(o.file, diagnostics);
  diagnostics.throw_if_errors();
  check_output(o, o.output, deck.get_files());
  const auto edits =
      nastran::convert_units(deck, {from.mass / to.mass, from.length / to.length, from.time / to.time}, diagnostics);
  diagnostics.throw_if_errors();
  const fs::path output = o.output;
  const auto written = deck.write(output.filename().string(), edits);
  std::vector<std::string> places;
  for (const auto& part : written) places.push_back((output.parent_path() / part.name).string());
  for (const auto& place : places) check_output(o, place, deck.get_files());
  // The deck itself comes last: it names the others.
  for (std::size_t i = written.size(); i-- > 0;) {
    write_text_file(places[i], written[i].text);
    console.print("written: " + places[i] + "\n");
  }
  console.print(count(edits.size(), "field") + " converted from " + from_name + " to " + to_name + "\n");
  return kSuccess;
}

}  // namespace

void add_convert(CLI::App& app, Action& action) {
  auto o = std::make_shared<ConvertOptions>();
  auto* verb = app.add_subcommand("convert", "A Nastran deck in other units; comments and order are kept");
  verb->add_option("deck", o->file, "Nastran deck, with its INCLUDE files")->required();
  auto* units = verb->add_option("--units", o->units, "FROM:TO, as mm-N-tonne:m-kg-s")->type_name("FROM:TO");
  auto* from = verb->add_option("--from", o->from, "The deck's units, as mm-N-tonne or in-lbf-s")->excludes(units);
  auto* to = verb->add_option("--to", o->to, "The units wanted")->excludes(units);
  from->needs(to);
  to->needs(from);
  add_common_options(*verb, *o, kOutput, "The deck to write");
  verb->get_option("--output")->required();
  verb->footer(
      "Units: m mm cm um km in ft, kg g mg t tonne lbm slug slinch, N mN kN MN lbf kgf, s ms min h; of mass, length, "
      "force and time three give the fourth.\n"
      "Example:\n  bough convert wing.bdf --units mm-N-tonne:m-kg-s -o wing-si.bdf");
  verb->callback([&action, o] { action = [o] { return run_convert(*o); }; });
}

}  // namespace bough::cli
