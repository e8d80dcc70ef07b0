#include "cli/convert/convert.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/convert/unit_system.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/hdf5/body_accuracy.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/nastran/unit_conversion.hpp"
#include "formats/records/flex_body_units.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/specs.hpp"
#include "formats/toml/unit_change.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct ConvertOptions : CommonOptions {
  std::string file, units, from, to;
  bool to_radians = false;
};

void convert_deck(const ConvertOptions& o, const records::UnitChange& change, const std::string& names,
                  const Console& console) {
  Diagnostics diagnostics;
  const nastran::DeckEditor deck(o.file, diagnostics);
  diagnostics.throw_if_errors();
  check_output(o, o.output, deck.get_files());
  const auto edits = nastran::convert_units(deck, {change.mass, change.length, change.time}, diagnostics);
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
  console.print(count(edits.size(), "field") + names);
}

/// Loads and elements of the flexible bodies of a system file; a body whose file is missing has none.
class FileFacts {
 public:
  explicit FileFacts(const std::string& system) {
    Diagnostics quiet;
    const auto spec = toml_files::read_system_spec(system, quiet);
    for (const auto& body : spec.bodies)
      if (!body.file.empty()) files_.emplace(body.name, (fs::path(system).parent_path() / body.file).string());
  }

  const records::FlexBody* find(const std::string& name) {
    const auto file = files_.find(name);
    if (file == files_.end()) return nullptr;
    if (const auto known = bodies_.find(name); known != bodies_.end()) return known->second.get();
    std::unique_ptr<records::FlexBody> body;
    try {
      Diagnostics quiet;
      body = std::make_unique<records::FlexBody>(analysis::read_body(file->second, quiet));
    } catch (const InputError&) {  // reported where it is needed
    }
    return bodies_.emplace(name, std::move(body)).first->second.get();
  }

  int find_direction(const std::string& name, const std::string& locator) {
    if (const auto* body = find(name))
      for (const auto& l : body->locators)
        if (l.name == locator) return l.direction;
    return -1;
  }

  std::vector<std::string> find_components(const std::string& name, int element) {
    if (const auto* body = find(name))
      for (const auto& block : body->recovery)
        if (std::find(block.id.begin(), block.id.end(), element) != block.id.end()) return block.components;
    return {};
  }

 private:
  std::map<std::string, std::string> files_;
  std::map<std::string, std::unique_ptr<records::FlexBody>> bodies_;
};

void convert_toml(const ConvertOptions& o, const records::UnitChange& change, const std::string& names,
                  const Console& console) {
  check_output(o, o.output, {o.file});
  Diagnostics diagnostics;
  std::ifstream in(o.file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  toml_files::check_text(text, o.file, diagnostics);
  diagnostics.throw_if_errors();
  FileFacts files(o.file);
  const toml_files::BodyFacts facts{
      [&](const std::string& body, const std::string& locator) { return files.find_direction(body, locator); },
      [&](const std::string& body, int element) { return files.find_components(body, element); }};
  int num_changed = 0;
  records::UnitLabels labels;
  if (!o.units.empty() || !o.to.empty()) {
    const auto names_of = name_units(o.units.empty() ? o.to : split_units(o.units).second);
    labels = {names_of.length, names_of.mass, names_of.time, names_of.force};
  }
  const auto changed =
      toml_files::change_units(text, o.file, change, o.to_radians, facts, labels, diagnostics, num_changed);
  diagnostics.throw_if_errors();
  console.print(diagnostics);
  write_text_file(o.output, changed);
  console.print("written: " + o.output + "\n");
  console.print(count(static_cast<std::size_t>(num_changed), "value") + names);
}

void convert_body(const ConvertOptions& o, const records::UnitChange& change, const std::string& names,
                  const Console& console) {
  check_output(o, o.output, {o.file});
  const bool is_to_flat = analysis::is_flat(o.file);
  auto body = is_to_flat ? flat::read_flex_body(o.file) : hdf5::read_flex_body(o.file);
  records::change_units(body, change);
  if (is_to_flat)
    write_text_file(o.output, flat::format_flex_body(body));
  else
    hdf5::write_flex_body(body, hdf5::read_body_accuracy(o.file), o.output);
  console.print("written: " + o.output + "\nflexible body" + names);
}

bool is_hdf5(const std::string& path) {
  std::string begin(8, '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), 8);
  return begin == "\x89HDF\r\n\x1a\n";
}

int run_convert(const ConvertOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  analysis::demand_file(o.file);
  const bool is_toml = fs::path(o.file).extension() == ".toml", has_units = !(o.units.empty() && o.from.empty());
  if (!has_units && !(is_toml && o.to_radians))
    throw InputError("cli.bad-units", {}, "the units are not given", "write --units mm-N-tonne:m-kg-s");
  records::UnitChange change;
  std::string names = " converted\n";
  if (has_units) {
    const auto [from_name, to_name] = o.units.empty() ? std::pair{o.from, o.to} : split_units(o.units);
    const auto from = parse_units(from_name), to = parse_units(to_name);
    change = {from.mass / to.mass, from.length / to.length, from.time / to.time};
    names = " converted from " + from_name + " to " + to_name + "\n";
  }
  if (is_toml)
    convert_toml(o, change, names, console);
  else if (is_hdf5(o.file) || analysis::is_flat(o.file))
    convert_body(o, change, names, console);
  else
    convert_deck(o, change, names, console);
  return kSuccess;
}

}  // namespace

void add_convert(CLI::App& app, Action& action) {
  auto o = std::make_shared<ConvertOptions>();
  auto* verb = add_verb(app, "convert",
                        "A deck, system, body or flexible-body file in other units; comments and order are kept");
  verb->add_option("file", o->file, "Nastran deck with its INCLUDE files, system or body file, flexible body")
      ->required();
  auto* units = verb->add_option("--units", o->units, "FROM:TO, as mm-N-tonne:m-kg-s")->type_name("FROM:TO");
  auto* from = verb->add_option("--from", o->from, "The file's units, as mm-N-tonne or in-lbf-s")->excludes(units);
  auto* to = verb->add_option("--to", o->to, "The units wanted")->excludes(units);
  from->needs(to);
  to->needs(from);
  verb->add_flag("--radians", o->to_radians, "System file: keys in degrees (_deg) become radians");
  add_common_options(*verb, *o, kOutput, "The file to write");
  verb->get_option("--output")->required();
  verb->footer(
      "Units: m mm cm um km in ft, kg g mg t tonne lbm slug slinch, N mN kN MN lbf kgf, s ms min h; of mass, length, "
      "force and time three give the fourth.\n"
      "Example:\n  bough convert wing.bdf --units mm-N-tonne:m-kg-s -o wing-si.bdf\n"
      "  bough convert spinup.toml --units m-kg-s:mm-N-tonne --radians -o mm/spinup.toml");
  verb->callback([&action, o] { action = [o] { return run_convert(*o); }; });
}

}  // namespace bough::cli
