#include "cli/studio/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "analysis/check/diagram.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/spec_functions.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/edit/command_words.hpp"
#include "analysis/edit/edit_session.hpp"
#include "analysis/edit/text_diff.hpp"
#include "analysis/init/init_deck.hpp"
#include "analysis/picture/deck_picture.hpp"
#include "analysis/report/preview.hpp"
#include "analysis/report/report_files.hpp"
#include "base/file_roles.hpp"
#include "cli/common/console.hpp"
#include "cli/common/json_rows.hpp"
#include "cli/init/schema_line.hpp"
#include "cli/studio/deck_answer.hpp"
#include "cli/studio/folder.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/schema_help.hpp"
#include "formats/toml/specs.hpp"
#include "report/linear_chapter.hpp"

namespace bough::cli {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

json make_messages(const std::vector<Diagnostic>& items) {
  auto list = json::array();
  for (const auto& item : items)
    list.push_back({{"severity", item.severity == Severity::Error     ? "error"
                                 : item.severity == Severity::Warning ? "warning"
                                                                      : "note"},
                    {"id", item.id},
                    {"file", item.where.file},
                    {"line", item.where.line},
                    {"what", item.what},
                    {"advice", item.advice}});
  return list;
}

/// A text of the request. \throws InputError "studio.bad-request".
std::string get_text(const json& request, const char* key) {
  const auto found = request.find(key);
  if (found == request.end() || !found->is_string())
    throw InputError("studio.bad-request", {}, fmt::format("the request has no text \"{}\"", key), "reload the page");
  return found->get<std::string>();
}

/// Name of a file as the reports show it, relative to the folder.
std::string get_file(const json& request) {
  const auto name = get_text(request, "file");
  if (name.empty() || name.find('\0') != std::string::npos)
    throw InputError("studio.bad-request", {}, "the name of a file is empty or has a zero byte", "name a file");
  return name;
}

json to_json(const report::Chapter& chapter) {
  json out{{"kind", chapter.kind},
           {"title", chapter.title},
           {"verdict", report::get_word(chapter.get_verdict())},
           {"facts", chapter.facts},
           {"settings", chapter.settings},
           {"checks", json::array()},
           {"highlights", json::array()},
           {"panels", json::array()},
           {"data", chapter.data}};
  for (const auto& c : chapter.checks)
    out["checks"].push_back(
        {{"what", c.what}, {"value", c.value}, {"verdict", report::get_word(c.verdict)}, {"note", c.note}});
  for (const auto& h : chapter.highlights)
    out["highlights"].push_back({{"name", h.name}, {"value", h.value}, {"note", h.note}});
  for (const auto& p : chapter.panels) out["panels"].push_back({{"id", p.id}, {"title", p.title}, {"html", p.html}});
  return out;
}

json answer_list() {
  auto files = json::array();
  for (const auto& entry : list_folder())
    files.push_back({{"name", entry.name}, {"kind", entry.kind}, {"size", entry.size}, {"time", entry.time}});
  return {{"files", files}, {"folder", fs::current_path().filename().string()}};
}

json answer_read(const json& request) {
  const auto name = get_file(request);
  auto file = read_file_text(name);
  json out{{"text", std::move(file.text)}, {"hash", file.hash}};
  if (analysis::has_suffix(name, ".toml")) out["kind"] = toml_files::detect_kind(name);
  return out;
}

json answer_save(const json& request) {
  return {{"hash", save_file_text(get_file(request), get_text(request, "text"), get_text(request, "hash"))}};
}

json answer_chapter(const json& request) {
  Diagnostics diagnostics;
  analysis::ReportRequest report;
  report.files = {get_file(request)};
  if (const auto more = request.find("bodies"); more != request.end())
    for (const auto& name : *more) report.files.push_back(name.get<std::string>());
  analysis::demand_file(report.files.front());
  const auto chapter = analysis::make_chapter(report.files.front(), report, diagnostics);
  return {{"chapter", to_json(chapter)}, {"messages", make_messages(diagnostics.items())}};
}

/// Texts of `bough init DECK`; the deck is named relative to the folder of the deck itself.
json answer_start(const json& request) {
  const auto name = get_file(request);
  analysis::demand_deck(name);
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck(name, {}, diagnostics);
  diagnostics.throw_if_errors();
  const fs::path path(name);
  auto files = json::array();
  for (auto& file :
       analysis::make_start_files(deck, {path.filename().string(), path.stem().string(), request.value("hinge", 0)})) {
    add_schema_line(file);
    files.push_back({{"name", (path.parent_path() / file.name).generic_string()}, {"text", file.text}});
  }
  return {{"files", files}, {"messages", make_messages(diagnostics.items())}};
}

/// Prints nothing; the commands that the editor of the page offers write and run nothing.
class QuietHost final : public analysis::EditHost {
 public:
  void print_data(const std::string&) override {}
  void print(const std::string&) override {}
  void print(const Diagnostics&) override {}
  void check_output(const std::string&) override {}
  int run_command(const std::vector<std::string>&) override { return 0; }
};

/// Commands of `bough edit` on a text that is not saved.
json answer_edit(const json& request) {
  static const std::vector<std::string> kAllowed{"add", "set", "unset", "delete", "rename", "copy", "change"};
  const auto text = get_text(request, "text");
  QuietHost host;
  analysis::EditSession session(analysis::EditText(get_file(request), text, get_text(request, "kind") == "body"), host,
                                {}, {});
  for (const auto& line : request.at("commands")) {
    const auto words = analysis::split_words(line.get<std::string>());
    if (!words.empty() && std::find(kAllowed.begin(), kAllowed.end(), words[0]) == kAllowed.end())
      throw InputError("cli.edit-command", {}, "'" + words[0] + "' is no command here",
                       "the commands are add, set, unset, delete, rename and copy");
    session.execute(line.get<std::string>());
  }
  return {{"text", session.get_text()}};
}

/// Ends of the hinges and nodes of the rigid bodies, with the values of parameters: for dragging them in the scene.
json make_tree(const std::string& text, const std::string& name) {
  Diagnostics unused;  // the text was read without errors
  const auto spec = toml_files::read_system_spec_text(text, name, unused);
  const auto items = toml_files::list_items(text);
  const auto to_list = [](const Eigen::Vector3d& v) { return json{v.x(), v.y(), v.z()}; };
  json hinges = json::array(), nodes = json::object();
  for (const auto& hinge : spec.hinges) {
    const auto item = std::find_if(items.begin(), items.end(),
                                   [&](const auto& i) { return i.kind == "hinge" && i.name == hinge.name; });
    if (item == items.end()) continue;
    auto axes = json::array();  // of the hinge frame in the parent, by columns
    for (Eigen::Index k = 0; k < 3; ++k) axes.push_back(to_list(hinge.parent_rotation.col(k)));
    hinges.push_back({{"name", hinge.name},
                      {"path", item->path()},
                      {"free", hinge.type == records::HingeType::Free},
                      {"parent", hinge.parent},
                      {"child", hinge.child},
                      {"parent_node", hinge.parent_node},
                      {"child_node", hinge.child_node},
                      {"parent_position", to_list(hinge.parent_position)},
                      {"child_position", to_list(hinge.child_position)},
                      {"axes", axes},
                      {"position", hinge.position}});
  }
  for (const auto& body : spec.bodies)
    for (const auto& node : body.nodes) nodes[body.name].push_back({{"id", node.id}, {"position", to_list(node.p)}});
  return {{"hinges", hinges}, {"nodes", nodes}};
}

/// All messages that `bough edit` has for a text: of the schema, then of what a run or reduce would refuse at once.
json answer_check(const json& request) {
  const auto name = get_file(request), text = get_text(request, "text");
  const bool is_body = get_text(request, "kind") == "body";
  Diagnostics diagnostics;
  json out;
  try {
    toml_files::check_text(text, name, diagnostics);
    if (diagnostics.num_errors() == 0 && is_body) {
      const auto spec = toml_files::read_body_spec_text(text, name, diagnostics);
      out["deck"] = spec.deck.empty() ? "" : fs::path(analysis::resolve_beside(name, spec.deck)).generic_string();
      out["interface"] = spec.interface_nodes;
    } else if (diagnostics.num_errors() == 0) {
      analysis::LoadOptions options;
      options.text = text;
      const auto loaded = analysis::load_system(name, diagnostics, options);
      out["speeds"] = loaded.system.num_dofs();
      auto bodies = json::array();
      for (const auto& [written, path] : loaded.flex_path) bodies.push_back(path);
      out["bodies"] = bodies;
      out["tree"] = make_tree(text, name);
    }
  } catch (const Failure& failure) {
    for (const auto& item : failure.items()) diagnostics.add_new(item);
  }
  out["items"] = json::array();
  for (const auto& item : toml_files::list_items(text))
    out["items"].push_back(
        {{"path", item.path()}, {"kind", item.kind}, {"name", item.name}, {"type", item.type}, {"line", item.line}});
  // Numbers of [parameters], for runs with other values.
  out["parameters"] = json::array();
  for (const auto& item : toml_files::list_items(text))
    for (const auto& key : item.keys)
      if (item.kind == "parameters")
        out["parameters"].push_back({{"name", key}, {"value", toml_files::get_value_text(text, "parameters." + key)}});
  out["messages"] = make_messages(diagnostics.items());
  return out;
}

/// Keys of one table of a text with their values as the text has them: "hinge.2", "simulation".
json answer_table(const json& request) {
  const auto text = get_text(request, "text"), path = get_text(request, "path");
  auto values = json::object();
  for (const auto& item : toml_files::list_items(text))
    if (item.path() == path)
      for (const auto& key : item.keys) values[key] = toml_files::get_value_text(text, path + "." + key);
  return {{"values", values}};
}

json answer_schema(const json& request) {
  auto kinds = json::array();
  for (const auto& kind : toml_files::describe_kinds(get_text(request, "kind") == "body")) {
    using Key = toml_files::KeyHelp;
    const auto keys =
        make_rows(kind.keys, "name", &Key::name, "type", &Key::type, "choices", &Key::choices, "range", &Key::range,
                  "default", &Key::default_value, "description", &Key::description, "required", &Key::is_required);
    kinds.push_back({{"kind", kind.kind}, {"description", kind.description}, {"list", kind.is_list}, {"keys", keys}});
  }
  return {{"kinds", kinds}};
}

/// The table that begins at `line`, as commands of `bough edit` name it: "connect.2".
std::string name_table(const std::vector<toml_files::TableItem>& items, int line) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.line == line; });
  return found == items.end() ? "" : found->path();
}

/// Block diagram and curves of the functions of a system file's text, each with its line; of the text after `commands`
/// of `bough edit`, if there are some.
json answer_diagram(const json& request) {
  const auto name = get_file(request);
  const auto text = get_text(request.contains("commands") ? answer_edit(request) : request, "text");
  Diagnostics diagnostics;
  // Not built: a system whose controller has lost its input is drawn too.
  const auto spec = toml_files::read_system_spec_text(text, name, diagnostics);
  diagnostics.throw_if_errors();
  const auto items = toml_files::list_items(text);
  const auto find_line = [&](const std::string& kind, const std::string& of) {
    const auto found =
        std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.kind == kind && i.name == of; });
    return found == items.end() ? 0 : found->line;
  };
  static constexpr const char* kLinks[] = {"signal", "push", "measurement", "hinge", "constraint", "element", "event"};
  const auto diagram = analysis::make_diagram(spec);
  json nodes = json::array(), edges = json::array(), functions = json::array();
  for (const auto& node : diagram.nodes)
    nodes.push_back({{"id", node.id()},
                     {"kind", node.kind},
                     {"name", node.name},
                     {"label", node.label},
                     {"line", find_line(node.kind, node.name)}});
  for (const auto& edge : diagram.edges) {
    edges.push_back({{"from", edge.from},
                     {"to", edge.to},
                     {"label", edge.label},
                     {"link", kLinks[static_cast<std::size_t>(edge.link)]}});
    if (edge.key.empty()) continue;
    edges.back()["signal"] = edge.signal;
    edges.back()["key"] = edge.key;
    edges.back()["table"] = name_table(items, edge.line);
  }
  for (const auto& curve : analysis::list_function_curves(spec)) {
    functions.push_back({{"name", curve.name},
                         {"type", curve.type},
                         {"of_time", curve.is_of_time},
                         {"line", find_line("function", curve.name)},
                         {"x", std::vector<double>(curve.x.begin(), curve.x.end())},
                         {"y", std::vector<double>(curve.y.begin(), curve.y.end())}});
    // Numbers and lists as the text has them: the page changes them in the curve.
    const auto item = std::find_if(items.begin(), items.end(),
                                   [&](const auto& i) { return i.kind == "function" && i.name == curve.name; });
    if (item == items.end()) continue;
    auto values = json::object();
    for (const auto& key : item->keys) values[key] = toml_files::get_value_text(text, item->path() + "." + key);
    functions.back()["path"] = item->path();
    functions.back()["values"] = values;
  }
  return {{"nodes", nodes}, {"edges", edges}, {"functions", functions}};
}

/// Returns the model that "poles" and "pole-motion" ask for: other values of parameters, at the start or at rest.
analysis::LinearizeRequest get_linearize_request(const json& request) {
  analysis::LinearizeRequest linearize;
  linearize.file = get_file(request);
  if (const auto set = request.find("set"); set != request.end()) linearize.set = set->get<std::vector<std::string>>();
  linearize.equilibrium = request.value("equilibrium", false);
  return linearize;
}

json answer_poles(const json& request) {
  Diagnostics diagnostics;
  const auto linearize = get_linearize_request(request);
  const auto model = analysis::linearize_text(linearize, get_text(request, "text"), diagnostics);
  return {{"chapter", to_json(report::make_chapter(model, {}, linearize.file, {}))},
          {"messages", make_messages(diagnostics.items())}};
}

json answer_pole_motion(const json& request) {
  Diagnostics diagnostics;
  const auto chapter = analysis::make_pole_motion(get_linearize_request(request), get_text(request, "text"),
                                                  request.value("pole", 0), diagnostics);
  return {{"chapter", to_json(chapter)}, {"messages", make_messages(diagnostics.items())}};
}

json answer_preview(const json& request) {
  Diagnostics diagnostics;
  const auto chapter = analysis::make_preview(get_file(request), get_text(request, "text"), diagnostics);
  return {{"chapter", to_json(chapter)}, {"messages", make_messages(diagnostics.items())}};
}

json answer(const json& request) {
  const auto what = get_text(request, "what");
  if (what == "list") return answer_list();
  if (what == "read") return answer_read(request);
  if (what == "save") return answer_save(request);
  if (what == "diff")
    return {{"diff", analysis::make_diff(get_text(request, "before"), get_text(request, "after"), get_file(request))}};
  if (what == "deck") {
    Diagnostics diagnostics;
    auto out = make_deck_answer(get_file(request), diagnostics);
    out["messages"] = make_messages(diagnostics.items());
    return out;
  }
  if (what == "chapter") return answer_chapter(request);
  if (what == "start") return answer_start(request);
  if (what == "edit") return answer_edit(request);
  if (what == "check") return answer_check(request);
  if (what == "table") return answer_table(request);
  if (what == "schema") return answer_schema(request);
  if (what == "preview") return answer_preview(request);
  if (what == "diagram") return answer_diagram(request);
  if (what == "poles") return answer_poles(request);
  if (what == "pole-motion") return answer_pole_motion(request);
  throw InputError("studio.bad-request", {}, "there is no request \"" + what + "\"", "reload the page");
}

}  // namespace

std::string answer_request(const std::string& request) {
  json out;
  try {
    out = {{"result", answer(json::parse(request))}};
  } catch (const Failure& failure) {
    out = {{"messages", make_messages(failure.items())}};
  } catch (const json::exception& error) {
    out = {{"messages", make_messages({{Severity::Error, "studio.bad-request", {}, error.what(), "reload the page"}})}};
  } catch (const std::exception& error) {
    out = {
        {"messages", make_messages({{Severity::Error, "", {}, error.what(), "this is a fault in Bough; report it"}})}};
  }
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

int answer_standard_input() {
  const std::string request{std::istreambuf_iterator<char>(std::cin), {}};
  const Console console(false, 0);
  console.print_data("\n" + answer_request(request) + "\n");
  return kSuccess;
}

}  // namespace bough::cli
