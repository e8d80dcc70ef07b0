#include "analysis/convert/convert.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <tuple>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/convert/unit_system.hpp"
#include "analysis/reduce/point_files.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/nastran/unit_conversion.hpp"
#include "formats/records/flex_body_units.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/specs.hpp"
#include "formats/toml/unit_change.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

void convert_deck(const ConvertRequest& request, const records::UnitChange& change, const CheckPath& check,
                  ConvertAnswer& answer) {
  Diagnostics diagnostics;
  const nastran::DeckEditor deck(request.file, diagnostics);
  diagnostics.throw_if_errors();
  check(request.output, deck.get_files());
  const auto edits = nastran::convert_units(deck, {change.mass, change.length, change.time}, diagnostics);
  diagnostics.throw_if_errors();
  const fs::path output = request.output;
  const auto written = deck.write(output.filename().string(), edits);
  // The deck itself comes last: it names the others.
  for (auto part = written.rbegin(); part != written.rend(); ++part)
    answer.files.push_back({(output.parent_path() / part->name).string(), part->text});
  for (auto file = answer.files.rbegin(); file != answer.files.rend(); ++file) check(file->path, deck.get_files());
  answer.num_changed = edits.size();
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

void convert_toml(const ConvertRequest& request, const records::UnitChange& change, const CheckPath& check,
                  Events& events, ConvertAnswer& answer) {
  check(request.output, {request.file});
  Diagnostics diagnostics;
  std::ifstream in(request.file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  toml_files::check_text(text, request.file, diagnostics);
  diagnostics.throw_if_errors();
  FileFacts files(request.file);
  if (!answer.from.empty()) {
    Diagnostics quiet;
    demand_labels(answer.from, toml_files::read_system_spec(request.file, quiet).units, {request.file});
  }
  const toml_files::BodyFacts facts{
      [&](const std::string& body, const std::string& locator) { return files.find_direction(body, locator); },
      [&](const std::string& body, int element) { return files.find_components(body, element); }};
  int num_changed = 0;
  records::UnitLabels labels;
  if (!answer.to.empty()) {
    const auto names = name_units(answer.to);
    labels = {names.length, names.mass, names.time, names.force};
  }
  auto changed =
      toml_files::change_units(text, request.file, change, request.to_radians, facts, labels, diagnostics, num_changed);
  diagnostics.throw_if_errors();
  add_messages(diagnostics, events);
  answer.num_changed = static_cast<std::size_t>(num_changed);
  answer.files = {{request.output, std::move(changed)}};
}

void convert_body(const ConvertRequest& request, const records::UnitChange& change, const CheckPath& check,
                  ConvertAnswer& answer) {
  check(request.output, {request.file});
  const bool is_to_flat = is_flat(request.file);
  answer.body = is_to_flat ? flat::read_flex_body(request.file) : hdf5::read_flex_body(request.file);
  records::change_units(answer.body, change);
  if (is_to_flat)
    answer.files = {{request.output, flat::format_flex_body(answer.body)}};
  else
    answer.accuracy = hdf5::read_body_accuracy(request.file);
}

}  // namespace

ConvertAnswer convert_file(const ConvertRequest& request, const CheckPath& check, Events& events) {
  demand_file(request.file);
  const bool is_toml = fs::path(request.file).extension() == ".toml",
             has_units = !(request.units.empty() && request.from.empty());
  if (!has_units && !(is_toml && request.to_radians))
    throw InputError("cli.bad-units", {}, "the units are not given", "write --units mm-N-tonne:m-kg-s");
  records::UnitChange change;
  ConvertAnswer answer;
  if (has_units) {
    std::tie(answer.from, answer.to) =
        request.units.empty() ? std::pair{request.from, request.to} : split_units(request.units);
    const auto from = parse_units(answer.from), to = parse_units(answer.to);
    change = {from.mass / to.mass, from.length / to.length, from.time / to.time};
  }
  if (is_toml) {
    answer.kind = ConvertedKind::Toml;
    convert_toml(request, change, check, events, answer);
  } else if (is_hdf5(request.file) || is_flat(request.file)) {
    answer.kind = ConvertedKind::FlexBody;
    convert_body(request, change, check, answer);
  } else if (is_flx(request.file)) {
    throw InputError("cli.wrong-file", {request.file}, "a .FLX file is not converted",
                     "convert the flexible body (.h5) that it was written from, and write it again by bough flx");
  } else {
    convert_deck(request, change, check, answer);
  }
  return answer;
}

}  // namespace bough::analysis
