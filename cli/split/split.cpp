#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/split/split.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/options.hpp"
#include "cli/common/output_folder.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct SplitOptions : CommonOptions {
  analysis::SplitRequest request;
  bool skips_check = false;
};

std::vector<std::string> list_body_files(const analysis::SplitRequest& request, const analysis::SplitAnswer& answer) {
  std::vector<std::string> names;
  for (const auto& part : answer.parts)
    if (request.is_checked) names.push_back(part.name + ".h5");
  return names;
}

std::string format_split(const analysis::SplitAnswer& answer) {
  Table parts{{"part", "carried by", "at grid", "elements", "grids", "modes", "mass"}, {}};
  double mass = 0;
  for (const auto& part : answer.parts) {
    mass += part.mass;
    const std::string at = part.num_joined > 0 ? count(static_cast<std::size_t>(part.num_joined), "grid")
                           : part.node == 0    ? "-"
                                               : std::to_string(part.node);
    parts.rows.push_back({part.name, part.parent, at, std::to_string(part.num_elements), std::to_string(part.num_grids),
                          answer.frequencies.empty() ? "-" : std::to_string(part.body.num_modes()),
                          fmt::format("{:.6g}", part.mass)});
  }
  std::string text =
      parts.to_text() + fmt::format("mass of the parts {:.9g}, of the deck {:.9g}: relative error {:.1e}\n", mass,
                                    answer.mass, std::abs(mass / answer.mass - 1));
  if (answer.frequencies.empty()) return text;
  Table modes{{"mode", "deck [Hz]", "parts [Hz]", "error"}, {}};
  for (std::size_t i = 0; i < answer.frequencies.size(); ++i) {
    const auto& frequency = answer.frequencies[i];
    modes.rows.push_back({std::to_string(i + 1), fmt::format("{:.6g}", frequency.whole_hz),
                          fmt::format("{:.6g}", frequency.parts_hz), fmt::format("{:.1e}", frequency.error())});
  }
  text += "\n" + modes.to_text();
  if (answer.deflections.empty()) return text;
  Table deflections{{"static load", "deflection", "error"}, {}};
  for (const auto& deflection : answer.deflections)
    deflections.rows.push_back(
        {deflection.load, fmt::format("{:.6g}", deflection.deflection), fmt::format("{:.1e}", deflection.error)});
  return text + "\n" + deflections.to_text();
}

nlohmann::json make_split_json(const analysis::SplitAnswer& answer, const std::vector<std::string>& files) {
  nlohmann::json parts = nlohmann::json::array(), frequencies = nlohmann::json::array(),
                 deflections = nlohmann::json::array();
  double mass = 0;
  for (const auto& part : answer.parts) {
    mass += part.mass;
    parts.push_back({{"name", part.name},
                     {"parent", part.parent},
                     {"node", part.node},
                     {"joined_grids", part.num_joined},
                     {"elements", part.num_elements},
                     {"grids", part.num_grids},
                     {"modes", part.body.num_modes()},
                     {"mass", part.mass}});
  }
  for (const auto& frequency : answer.frequencies)
    frequencies.push_back(
        {{"deck_hz", frequency.whole_hz},
         {"parts_hz", std::isfinite(frequency.parts_hz) ? nlohmann::json(frequency.parts_hz) : nlohmann::json(nullptr)},
         {"error", std::isfinite(frequency.parts_hz) ? nlohmann::json(frequency.error()) : nlohmann::json(nullptr)}});
  for (const auto& deflection : answer.deflections)
    deflections.push_back(
        {{"load", deflection.load}, {"deflection", deflection.deflection}, {"error", deflection.error}});
  return {{"mass", answer.mass},        {"parts_mass", mass},         {"parts", parts},
          {"frequencies", frequencies}, {"deflections", deflections}, {"files", files}};
}

int run_split(const SplitOptions& given) {
  auto o = given;
  Console console(o.quiet, o.verbosity);
  ConsoleEvents events(console);
  auto& request = o.request;
  request.is_checked = !o.skips_check;
  const fs::path folder = o.output.empty() ? fs::path(".") : fs::path(o.output);
  request.deck_path = fs::path(request.deck).filename().string();
  const auto answer = analysis::split_deck(request, events);
  console.print(events.get_messages());
  if (!console.is_root()) return kSuccess;
  std::vector<std::string> files;
  for (const auto& file : answer.files) files.push_back((folder / file.name).string());
  for (const auto& name : list_body_files(request, answer)) files.push_back((folder / name).string());
  make_output_folder(folder.string());
  check_outputs(o, files, {request.deck});
  for (std::size_t i = 0; i < answer.files.size(); ++i) analysis::write_text_file(files[i], answer.files[i].text);
  for (const auto& part : answer.parts)
    if (request.is_checked) hdf5::write_flex_body(part.body, (folder / (part.name + ".h5")).string());
  if (o.json) {
    console.print_data(make_split_json(answer, files).dump(2) + "\n");
    return kSuccess;
  }
  const auto& system = files[answer.files.size() - 1];
  console.print(format_split(answer) + "\nwritten: " + count(files.size(), "file") + ", of which " + system +
                " is the system\n");
  if (!request.is_checked) console.print("reduce each body file, then run the system\n");
  return kSuccess;
}

}  // namespace

void add_split(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_split, "split", &analysis::SplitRequest::deck);
  auto& choice = o->request.choice;
  verb->add_option("deck", o->request.deck, "Nastran deck")->required();
  verb->add_option("--parts", choice.num_parts, "Number of parts of equal length, cut at grids")
      ->check(make_positive());
  verb->add_option("--along", choice.along,
                   "Direction of --parts: path (over the elements from the held end), long (principal axis), x, y, z")
      ->check(CLI::IsMember({"path", "long", "x", "y", "z"}))
      ->capture_default_str();
  verb->add_option("--plane", choice.planes,
                   "Cut by a plane in basic: x=2.5, or NX,NY,NZ=D with its normal; repeatable")
      ->allow_extra_args(false);
  verb->add_option(
          "--elements", choice.elements,
          "Elements of one part: ids, ranges 17-25, property:3, card:CBAR, by commas; repeatable; what is left "
          "is a part, too")
      ->allow_extra_args(false);
  verb->add_option("--grids", choice.grids, "Cut at these grids")->delimiter(',');
  verb->add_option(
          "--interface", choice.interface,
          "Of a cut along several grids: rigid (RBE2 to a new grid), average (RBE3) or grids (a constraint at each)")
      ->check(CLI::IsMember({"rigid", "average", "grids"}))
      ->capture_default_str();
  verb->add_option("--name", o->request.name, "Name of the bodies NAME-1, NAME-2, ... (default: the deck's)");
  verb->add_option("--modes", o->request.num_compared, "Elastic modes of the deck that the parts are to have")
      ->check(make_positive())
      ->capture_default_str();
  verb->add_flag("--no-check", o->skips_check, "Write the files without reducing the parts and comparing their modes");
  verb->add_option("--subcase", o->request.model.subcase, "Subcase whose SPC and MPC are used (default: the first)");
  verb->add_option("--ignore", o->request.model.ignore_cards,
                   "Leave out this card, command or parameter though it changes the answer; may be repeated")
      ->allow_extra_args(false);
  add_common_options(*verb, *o, kOutput | kJson, "Folder to write into (default: here)");
}

}  // namespace bough::cli
