// Labels of lines with values, further lines of the extension, and the check for completeness.
#include <algorithm>
#include <limits>

#include "formats/flx/detail/flx_reader.hpp"
#include "formats/records/mode_kind.hpp"

namespace bough::flx::detail {

namespace {
constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();
}

void FlxReader::add_labels() {
  const auto matrix = [](MatrixXd& m) {
    return Label{"jk", [&m](const auto& at, int v) { return &m(at[0], at[1] + v); }, true};
  };
  const auto vector = [](MatrixXd& m) { return Label{"j", [&m](const auto& at, int v) { return &m(v, at[0]); }}; };
  const auto gains = [](std::vector<MatrixXd>& m, const char* shape, int first) {
    return Label{shape, [&m, first](const auto& at, int v) { return &m[at[0]](first + v, at[1]); }};
  };
  auto& g = file_.integrals;
  labels_["GMASS"] = matrix(file_.M);
  labels_["GSTIF"] = matrix(file_.K);
  labels_["GDAMP"] = matrix(file_.D);
  labels_["ALPHA"] = vector(file_.alpha);
  labels_["GAMMA1"] = vector(g.gamma1);
  labels_["GAMMA2"] = {"jk", [&g](const auto& at, int v) { return &g.gamma2[at[0]](v, at[1]); }};
  labels_["GAMMA3"] = {"ja", [&g](const auto& at, int v) { return &g.gamma3[at[0]](at[1], v); }};
  labels_["GAMMA4"] = {"jka", [&g](const auto& at, int v) { return &g.gamma4[at[0]][at[1]](at[2], v); }};
  labels_["NODE"] = {"m", [this](const auto& at, int v) { return &file_.node_xyz(at[0], v); }};
  labels_["PHI"] = gains(file_.gains, "nj", 0);
  labels_["PSI"] = gains(file_.gains, "nj", 3);
  labels_["SPHI"] = gains(file_.special_gains, "sj", 0);
  labels_["SPSI"] = gains(file_.special_gains, "sj", 3);
}

void FlxReader::add_extension_labels() {
  auto& more = file_.more;
  more.cg.setConstant(kNotGiven);
  more.inertia.setConstant(kNotGiven);
  labels_["!+CG"] = {"", [&more](const auto&, int v) { return &more.cg[v]; }};
  labels_["!+INERTIA"] = {"a", [&more](const auto& at, int v) { return &more.inertia(at[0], v); }};
  labels_["!+GAMMA0"] = {"j", [this](const auto& at, int v) { return &file_.integrals.gamma0(v, at[0]); }};
  labels_["!+KG1"] = {"ljk",
                      [this](const auto& at, int v) {
                        auto& K_G = file_.more.kg_inertial[static_cast<std::size_t>(at[0])];
                        if (!file_.more.kg_inertial_computed[static_cast<std::size_t>(at[0])])
                          K_G.setConstant(num_modes_, num_modes_, kNotGiven);
                        file_.more.kg_inertial_computed[static_cast<std::size_t>(at[0])] = true;
                        return &K_G(at[1], at[2] + v);
                      },
                      true};
  labels_["!+KG2"] = {"ejk", [&more](const auto& at, int v) { return &more.kg_external[at[0]](at[1], at[2] + v); },
                      true};
  labels_["!+LOAD"] = {"ej", [&more](const auto& at, int v) { return &more.external_load(at[1] + v, at[0]); }, true};
  labels_["!+RESULTANT"] = {"e",
                            [this](const auto& at, int v) {
                              auto& m = file_.more.load_resultant;
                              if (m.size() == 0) m.setConstant(6, num_locators_, kNotGiven);
                              return &m(v, at[0]);
                            },
                            false, 6};
  labels_["!+MOMENT"] = {"eaj",
                         [this](const auto& at, int v) {
                           auto& m = file_.more.load_moment;
                           if (m.empty())
                             m.assign(static_cast<std::size_t>(num_locators_),
                                      MatrixXd::Constant(3, num_modes_, kNotGiven));
                           return &m[static_cast<std::size_t>(at[0])](at[1], at[2] + v);
                         },
                         true};
  // Behind a PRELOAD line.
  labels_["!+KGP"] = {"jk",
                      [&more](const auto& at, int v) -> Slot {
                        return more.kg_preload.size() == 0 ? nullptr : &more.kg_preload(at[0], at[1] + v);
                      },
                      true};
  labels_["!+FACTOR"] = {"l",
                         [&more](const auto& at, int) -> Slot {
                           return more.preload_A_I.size() == 0 ? nullptr : &more.preload_A_I[at[0]];
                         },
                         false, 1};
}

std::string FlxReader::describe(const std::string& word) {
  std::vector<std::string> known{"BODY",    "NAME",     "MODOPT",     "METHOD",    "DIGITS",      "NMODE",
                                 "NNODE",   "NSPECIAL", "MASS",       "MODE",      "SNODE",       "END",
                                 "!+FRAME", "!+KIND",   "!+NLOCATOR", "!+LOCATOR", "!+INTERFACE", "!+PRELOAD"};
  for (const auto& [label, info] : labels_) known.push_back(label);
  if (std::find(known.begin(), known.end(), word) != known.end())
    return "its indices and values as docs/formats/flx.md says, after the counts";
  const auto nearest = find_nearest(word, known);
  return nearest.empty() ? "a label of docs/formats/flx.md" : "\"" + nearest + "\"";
}

bool FlxReader::read_extension(const std::string& label, const std::string& line) {
  if (!size()) return false;
  auto& more = file_.more;
  if (label == "!+FRAME") {
    file_.has_rigid = has_frame_ = true;
    more.is_free_free = words_.size() == 2 && words_[1] == "free";
    return words_.size() == 2 && (more.is_free_free || words_[1] == "fixed");
  }
  if (label == "!+KIND") return read_kind();
  if (label == "!+LOCATOR") return read_locator();
  if (label == "!+NLOCATOR") {
    int count = 0;
    if (file_.has_stiffening || words_.size() != 2 || !parse_value(words_[1], count)) return false;
    const double n = num_modes_;
    if (count < 0 || count * n * n > bytes_ || count > bytes_) return false;
    num_locators_ = count;
    file_.has_stiffening = true;
    size_locators();
    return true;
  }
  if (label == "!+PRELOAD") {
    more.preload = words_.size() > 1 ? line.substr(line.find("PRELOAD") + 8) : "";
    more.kg_preload.setConstant(num_modes_, num_modes_, kNotGiven);
    more.preload_A_I.setConstant(records::kNumInertialLoads, kNotGiven);
    return !more.preload.empty();
  }
  if (label == "!+INTERFACE") {
    for (std::size_t w = 1; w < words_.size(); ++w) {
      int id = 0;
      if (!parse_value(words_[w], id) || nodes_.find(id) < 0) return false;
      more.interface_nodes.push_back(id);
    }
    return true;
  }
  const bool is_rigid = label == "!+CG" || label == "!+INERTIA" || label == "!+GAMMA0";
  if (is_rigid) file_.has_rigid = true;
  // The other labels need the count of locators, which precedes them.
  return (is_rigid || file_.has_stiffening) && read_values(labels_.at(label));
}

void FlxReader::size_locators() {
  auto& more = file_.more;
  const auto count = static_cast<std::size_t>(num_locators_);
  more.locators.assign(count, records::Locator{});
  more.kg_external.assign(count, MatrixXd::Constant(num_modes_, num_modes_, kNotGiven));
  more.external_load.setConstant(num_modes_, num_locators_, kNotGiven);
}

bool FlxReader::read_kind() {
  int j = 0;
  if (words_.size() != 3 || !parse_value(words_[1], j) || j < 1 || j > num_modes_) return false;
  using records::ModeKind;
  for (const auto kind : {ModeKind::Normal, ModeKind::Constraint, ModeKind::Attachment, ModeKind::Residual}) {
    if (words_[2] != records::get_name(kind)) continue;
    file_.more.kind[static_cast<std::size_t>(j - 1)] = kind;
    return true;
  }
  return false;
}

bool FlxReader::read_locator() {
  int e = 0;
  if (words_.size() < 4 || !parse_value(words_[1], e) || e < 1 || e > num_locators_) return false;
  auto& locator = file_.more.locators[static_cast<std::size_t>(e - 1)];
  if (!parse_value(words_[2], locator.node) || !parse_value(words_[3], locator.direction)) return false;
  for (std::size_t w = 4; w < words_.size(); ++w) locator.name += (w > 4 ? " " : "") + words_[w];
  const bool is_pattern = locator.node == 0 && locator.direction == 0;
  return is_pattern || (nodes_.find(locator.node) >= 0 && locator.direction >= 1 && locator.direction <= 6);
}

void FlxReader::check(const char* label, bool is_complete) {
  if (!is_complete)
    diagnostics_.error("flx.missing-block", {path_}, std::string("values of ") + label + " are missing",
                       "write the file again");
}

void FlxReader::check_complete() {
  check("NMODE, NNODE or NSPECIAL", size());
  const auto is_set = [](const auto& m) { return !m.hasNaN(); };
  const auto all_set = [&](const auto& list) { return std::all_of(list.begin(), list.end(), is_set); };
  const auto& g = file_.integrals;
  check("MODE", std::find(file_.modes.begin(), file_.modes.end(), 0) == file_.modes.end());
  check("MASS", file_.mass > 0);
  check("GMASS", is_set(file_.M));
  check("GSTIF", is_set(file_.K));
  check("GDAMP", is_set(file_.D));
  check("ALPHA", is_set(file_.alpha));
  check("GAMMA1", is_set(g.gamma1));
  check("GAMMA2", all_set(g.gamma2));
  check("GAMMA3", all_set(g.gamma3));
  check("GAMMA4", std::all_of(g.gamma4.begin(), g.gamma4.end(), all_set));
  check("NODE", is_set(file_.node_xyz));
  check("PHI or PSI", all_set(file_.gains));
  check("SNODE", static_cast<int>(file_.special_id.size()) == num_special_ || !is_sized_);
  check("SPHI or SPSI", all_set(file_.special_gains));
}

void FlxReader::check_extension() {
  auto& more = file_.more;
  const auto is_set = [](const auto& m) { return !m.hasNaN(); };
  const auto all_set = [&](const auto& list) { return std::all_of(list.begin(), list.end(), is_set); };
  if (file_.has_rigid) {
    check("!+ CG", is_set(more.cg));
    check("!+ INERTIA", is_set(more.inertia));
    check("!+ FRAME", has_frame_);
    check("!+ GAMMA0", is_set(file_.integrals.gamma0));
  }
  if (!file_.has_stiffening) return;
  check("!+ LOCATOR", std::none_of(more.locators.begin(), more.locators.end(),
                                   [](const auto& locator) { return locator.name.empty() && locator.node == 0; }));
  check("!+ KG1", all_set(more.kg_inertial));
  check("!+ KG2", all_set(more.kg_external));
  check("!+ LOAD", is_set(more.external_load));
  check("!+ RESULTANT", is_set(more.load_resultant));
  check("!+ MOMENT", all_set(more.load_moment) && (more.load_moment.empty() || more.load_resultant.size() > 0));
  if (num_modes_ > 0)
    check("!+ MOMENT", more.load_resultant.size() == 0 || !more.load_moment.empty());
  else if (more.load_resultant.size() > 0)
    more.load_moment.assign(more.locators.size(), MatrixXd::Zero(3, 0));
  check("!+ KGP or FACTOR", is_set(more.kg_preload) && is_set(more.preload_A_I));
  for (auto& K_G : more.kg_inertial)
    if (K_G.size() == 0) K_G.setZero(num_modes_, num_modes_);
}

}  // namespace bough::flx::detail
