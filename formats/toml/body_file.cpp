#include <algorithm>
#include <array>
#include <map>

#include "formats/toml/detail/fields.hpp"
#include "formats/toml/detail/inertia.hpp"
#include "formats/toml/detail/matrices_table.hpp"
#include "formats/toml/detail/schema.hpp"
#include "formats/toml/specs.hpp"

namespace bough::toml_files {

namespace {

constexpr std::array<const char*, records::kNumInertialLoads> kInertialNames{
    "ax", "ay", "az", "alx", "aly", "alz", "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};

std::vector<records::InertialLoad> read_inertial(const Fields& table, Diagnostics& diagnostics) {
  std::vector<records::InertialLoad> loads;
  const Value* v = table.find("inertial");
  if (!v) return loads;
  if (v->is_string()) {
    if (v->text != "all") {
      diagnostics.error("toml.bad-value", table.locate("inertial"),
                        "inertial is '" + v->text + "', expected \"all\" or a list of names",
                        "write inertial = [\"" + v->text + "\"] for one of them");
    }
    return loads;
  }
  for (const std::string& word : table.get_strings("inertial")) {
    const auto it = std::find(kInertialNames.begin(), kInertialNames.end(), word);
    if (it == kInertialNames.end()) continue;
    const auto load = static_cast<records::InertialLoad>(it - kInertialNames.begin());
    if (std::find(loads.begin(), loads.end(), load) == loads.end()) loads.push_back(load);
  }
  return loads;
}

std::vector<int> read_directions(const Fields& load, Diagnostics& diagnostics) {
  static const std::vector<std::string> names{"x", "y", "z", "rx", "ry", "rz"};
  const Value* v = load.find("direction");
  if (!v) return load.has("node") ? std::vector<int>{1, 2, 3} : std::vector<int>{};
  std::vector<int> directions;
  auto add = [&](const Value& item) {
    int direction = 0;
    if (item.is_string()) {
      const auto it = std::find(names.begin(), names.end(), item.text);
      if (it != names.end()) direction = static_cast<int>(it - names.begin()) + 1;
    } else if (item.kind == Value::Kind::Integer && item.integer >= 1 && item.integer <= 6) {
      direction = static_cast<int>(item.integer);
    }
    if (direction > 0) {
      directions.push_back(direction);
    } else if (!v->is_array()) {  // items of a list were checked by the schema
      diagnostics.error("toml.bad-value", load.locate("direction"),
                        "direction is " + (item.is_string() ? "'" + item.text + "'" : std::to_string(item.integer)) +
                            ", expected 1 to 6 or one of x, y, z, rx, ry, rz");
    }
  };
  if (v->is_array()) {
    for (const Value& item : v->items) add(item);
  } else if (v->is_string() || v->kind == Value::Kind::Integer) {
    add(*v);
  }
  return directions;
}

void read_loads(const Fields& body, records::BodySpec& spec, Diagnostics& diagnostics) {
  std::map<std::string, int> lines;
  for (const Fields& table : body.get_tables("load")) {
    records::ExternalLoadSpec load;
    load.at = table.locate();
    load.name = table.get_string("name");
    load.node = table.get_int("node", 0);
    load.load_set = table.get_int("load_set", 0);
    load.temperature_set = table.get_int("temperature_set", 0);
    load.directions = read_directions(table, diagnostics);
    for (const std::string set : {"load_set", "temperature_set"})
      if (table.has(set) && table.has("direction"))
        diagnostics.error("toml.conflicting-keys", table.locate("direction"),
                          "'" + set + "' and 'direction' stand together in load '" + load.name + "'",
                          "keep one of them");
    const auto [it, is_new] = lines.emplace(load.name, load.at.line);
    if (!is_new && !load.name.empty()) {
      diagnostics.error("toml.duplicate-name", table.locate("name"),
                        "load '" + load.name + "' was already given in line " + std::to_string(it->second),
                        "rename one of them");
    }
    spec.loads.push_back(std::move(load));
  }
}

void read_augments(const Fields& body, records::BodySpec& spec, Diagnostics& diagnostics) {
  for (const Fields& table : body.get_tables("augment")) {
    records::AugmentSpec augment;
    augment.at = table.locate();
    augment.node = table.get_int("node", 0);
    augment.mass = table.get_number("mass", 0);
    augment.cg = table.get_vector("cg", augment.cg);
    augment.inertia = read_inertia(table, diagnostics);
    spec.augments.push_back(augment);
  }
}

/// [body.preload], or [preload] on its own.
void read_preload(const Fields& table, records::BodySpec& spec, Diagnostics& diagnostics) {
  records::PreloadSpec preload;
  preload.at = table.locate();
  preload.subcase = table.get_int("subcase", 0);
  preload.load_set = table.get_int("load_set", 0);
  preload.temperature_set = table.get_int("temperature_set", 0);
  preload.spin = table.get_vector("spin", Eigen::Vector3d::Zero());
  preload.is_nonlinear = table.get_bool("nonlinear", false);
  for (const std::string other : {"load_set", "temperature_set"})
    if (table.has("subcase") && table.has(other))
      diagnostics.error("toml.conflicting-keys", table.locate(other),
                        "'subcase' and '" + other + "' stand together in preload",
                        "the subcase says what loads: keep one of them");
  spec.preload = preload;
}

records::BodyFrame read_frame(const std::string& word) {
  using records::BodyFrame;
  static const std::map<std::string, BodyFrame> frames{{"free", BodyFrame::Free},
                                                       {"mean", BodyFrame::MeanAxes},
                                                       {"node", BodyFrame::Node},
                                                       {"3-2-1", BodyFrame::ThreeNodes},
                                                       {"mass-centre", BodyFrame::MassCentre}};
  const auto found = frames.find(word);
  return found == frames.end() ? BodyFrame::Fixed : found->second;
}

/// Three numbers, a node, or "mass-centre".
void read_origin(const Fields& body, records::BodySpec& spec, Diagnostics& diagnostics) {
  const Value* v = body.find("origin");
  if (!v) return;
  if (v->is_array()) spec.origin = body.get_vector("origin", Eigen::Vector3d::Zero());
  if (v->kind == Value::Kind::Integer) spec.origin_node = body.get_int("origin", 0);
  if (!v->is_string()) return;
  spec.origin_at_mass_centre = v->text == "mass-centre";
  if (!spec.origin_at_mass_centre)
    diagnostics.error("toml.bad-value", body.locate("origin"),
                      "origin is '" + v->text + "', expected three numbers, a node id or \"mass-centre\"");
}

void set_places(const Fields& table, const std::string& path, records::BodySpec& spec) {
  for (const auto& entry : table.entries()) {
    spec.places[path + entry.key] = table.locate(entry.key);
    if (entry.value.is_table()) set_places(table.get_table(entry.key), path + entry.key + "/", spec);
  }
}

void read_more_damping(const Fields& damping, records::BodySpec& spec) {
  if (const Value* table = damping.find("table")) {
    for (const Value& row : table->items)
      if (row.items.size() == 2 && row.items[0].is_number() && row.items[1].is_number())
        spec.damping_table.points.emplace_back(row.items[0].number, row.items[1].number);
  }
  spec.damping_table.kind = damping.get_string("table_kind", spec.damping_table.kind);
  if (const auto rayleigh = damping.get_numbers("rayleigh"); rayleigh.size() == 2) {
    spec.rayleigh_alpha = rayleigh[0];
    spec.rayleigh_beta = rayleigh[1];
  }
  spec.structural_damping = damping.get_number("structural", 0);
  spec.has_material_damping = damping.get_bool("material", false);
  spec.residual_damping = damping.get_number("residual_ratio");
}

}  // namespace

records::BodySpec read_body_spec(const std::string& path, Diagnostics& diagnostics) {
  std::string text;
  if (read_text(path, text, diagnostics)) return read_body_spec_text(text, path, diagnostics);
  records::BodySpec spec;
  spec.file = path;
  return spec;
}

records::BodySpec read_body_spec_text(const std::string& text, const std::string& path, Diagnostics& diagnostics) {
  records::BodySpec spec;
  spec.file = path;
  Value root;
  if (!parse_toml(text, path, root, diagnostics)) return spec;
  check_schema(root, get_body_schema(), path, diagnostics);

  const Fields body = Fields(root, path).get_table("body");
  set_places(body, "", spec);
  spec.name = body.get_string("name", get_stem(path));
  spec.deck = resolve_path(path, body.get_string("deck"));
  spec.subcase = body.get_int("subcase", 0);
  spec.frame = read_frame(body.get_string("frame"));
  spec.frame_nodes = body.get_ints("frame_nodes");
  spec.support = body.get_ints("support");
  spec.interface_nodes = body.get_ints("interface");
  spec.interface_moments = body.get_bool("interface_moments", true);
  read_origin(body, spec, diagnostics);
  spec.mass = body.get_string("mass", spec.mass);
  spec.integrals = body.get_string("integrals", spec.integrals);
  spec.ignore_cards = body.get_strings("ignore");
  if (body.get_string("frame", "fixed") == "fixed" && !spec.support.empty()) {
    diagnostics.error("toml.conflicting-keys", body.locate("support"),
                      "'support' stands with frame = \"fixed\", where the deck's constraints are the support",
                      "remove it, or set frame = \"free\"");
  }

  const Fields modes = body.get_table("modes");
  spec.num_modes = modes.get_int("number", 0);
  spec.max_frequency_hz = modes.get_number("max_frequency");
  spec.select = modes.get_ints("select");
  spec.residual = modes.get_strings("residual");
  spec.orthogonalize = modes.get_bool("orthogonalize", true);
  if (const auto basis = modes.get_string("basis"); basis == "craig-bampton")
    spec.basis = records::BodyBasis::CraigBampton;
  else if (basis == "craig-chang")
    spec.basis = records::BodyBasis::CraigChang;
  if (modes.has("number") && spec.basis == records::BodyBasis::Normal && spec.residual.empty()) {
    for (const int mode : spec.select) {
      if (mode <= spec.num_modes) continue;
      diagnostics.error(
          "toml.out-of-range", modes.locate("select"),
          "select names mode " + std::to_string(mode) + ", expected at most number = " + std::to_string(spec.num_modes),
          "raise number or leave the mode out");
    }
  }

  const Fields stiffening = body.get_table("stiffening");
  spec.inertial_loads = read_inertial(stiffening, diagnostics);
  spec.stiffening_order = stiffening.get_int("order", 2);
  if (const Value* large = stiffening.find("large"); large && large->is_array())
    spec.large_modes = stiffening.get_ints("large");
  else
    spec.num_large = stiffening.get_int("large", 0);
  if (stiffening.has("large") && spec.stiffening_order < 3)
    diagnostics.error("toml.conflicting-keys", stiffening.locate("large"),
                      "'large' names the modes of third order, but order is 2", "add order = 3, or remove 'large'");
  read_loads(body, spec, diagnostics);
  read_augments(body, spec, diagnostics);
  for (const Fields& parent : {body, Fields(root, path)})
    if (parent.has("preload")) {
      if (spec.preload)
        diagnostics.error("toml.conflicting-keys", parent.locate("preload"),
                          "[body.preload] and [preload] stand together", "keep one of them");
      read_preload(parent.get_table("preload"), spec, diagnostics);
    }

  spec.matrices = read_matrices_spec(body, path, diagnostics);

  const Fields damping = body.get_table("damping");
  spec.damping_ratio = damping.get_number("ratio", 0);
  spec.damping_ratios = damping.get_numbers("ratios");
  read_more_damping(damping, spec);

  const Fields output = body.get_table("output");
  spec.output_file = resolve_path(path, output.get_string("file"));
  spec.output_nodes = output.get_ints("nodes");
  spec.full = output.get_bool("full", false);
  spec.strain_energy = output.get_bool("strain_energy", false);
  if (const Value* recover = output.find("recover")) {
    if (recover->is_string()) spec.recover.push_back(recover->text);
    for (const Value& item : recover->items)
      spec.recover.push_back(item.is_string() ? item.text : std::to_string(item.integer));
  }
  if (const Value* nodes = output.find("nodes"); nodes && nodes->is_string() && nodes->text != "all") {
    diagnostics.error("toml.bad-value", output.locate("nodes"),
                      "nodes is '" + nodes->text + "', expected \"all\" or a list of node ids");
  }
  return spec;
}

std::string detect_kind(const std::string& path) {
  Diagnostics ignored;
  std::string text;
  if (!read_text(path, text, ignored)) return {};
  Value root;
  if (parse_toml(text, path, root, ignored)) {
    const Value* body = root.find("body");
    if (body && body->is_table()) return "body";
    if (root.find("campaign")) return "campaign";
    if (root.find("psd")) return "psd";
    if (root.find("source")) return "budget";
    if ((body && body->is_array()) || root.find("simulation") || root.find("hinge")) return "system";
    return {};
  }
  // Text with a syntax error still has its table headings: the next reader reports the error.
  for (const char* heading : {"\n[[body]]", "\n[[hinge]]", "\n[simulation]"}) {
    if (("\n" + text).find(heading) != std::string::npos) return "system";
  }
  return ("\n" + text).find("\n[body]") != std::string::npos ? "body" : "";
}

}  // namespace bough::toml_files
