#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <sstream>
#include <unordered_map>

#include "base/diagnostic.hpp"
#include "formats/flx/flx_file.hpp"

namespace bough::flx {

namespace {

constexpr int kMostCount = 1000000;
constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

template <class Number>
bool parse(const std::string& word, Number& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

class FlxReader {
 public:
  explicit FlxReader(const std::string& path) : path_(path), in_(path, std::ios::binary) {
    if (!in_) throw InputError("flx.cannot-read", {path}, "the file cannot be read", "check its path and permissions");
  }

  FlxFile read() {
    read_first_line();
    std::string line;
    while (!ended_ && std::getline(in_, line)) {
      ++line_;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      std::istringstream words(line);
      std::string word;
      words_.clear();
      while (words >> word) words_.push_back(word);
      if (words_.empty() || words_[0][0] == '!') continue;
      if (words_[0] == "NAME") {
        file_.name = line.size() > 5 ? line.substr(5) : "";
      } else if (!read_line()) {
        diagnostics_.error("flx.bad-line", {path_, line_}, "cannot read the line with the label \"" + words_[0] + "\"",
                           "expected " + describe(words_[0]));
      }
    }
    if (!ended_)
      diagnostics_.error("flx.missing-block", {path_}, "the file ends without END", "write it again: it was cut");
    check_complete();
    diagnostics_.throw_if_errors();
    file_.integrals.gamma0 = file_.mass * file_.alpha;
    return std::move(file_);
  }

 private:
  void read_first_line() {
    std::string line, word, version;
    std::getline(in_, line);
    line_ = 1;
    std::istringstream(line) >> word >> version;
    if (word != "FLX")
      throw InputError("flx.not-flx", {path_, 1}, "the first line does not start with FLX",
                       "give a file that bough flx or bough integrals wrote without --layout");
    if (version.rfind("1.", 0) != 0)
      throw InputError("flx.version", {path_, 1}, "the file has version " + version + ", expected 1.x",
                       "use a newer Bough");
  }

  /// What the values of a label are read into; -1 in `slots` for none.
  using Slot = double*;
  struct Label {
    std::string shape;  ///< the indices before the values: m new node, n node, s special node, j k modes, a axis
    std::function<Slot(const std::vector<int>&, int)> place;  ///< of the v-th value
    bool runs = false;                                        ///< values run over k to the end of the row
  };

  const std::map<std::string, Label>& get_labels() {
    if (!labels_.empty()) return labels_;
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
    return labels_;
  }

  std::string describe(const std::string& word) {
    std::vector<std::string> known{"BODY",  "NAME",     "MODOPT", "METHOD", "DIGITS", "NMODE",
                                   "NNODE", "NSPECIAL", "MASS",   "MODE",   "SNODE",  "END"};
    for (const auto& [label, info] : get_labels()) known.push_back(label);
    if (std::find(known.begin(), known.end(), word) != known.end())
      return "its indices and values as docs/formats/flx.md says, after the counts";
    const auto nearest = find_nearest(word, known);
    return nearest.empty() ? "a label of docs/formats/flx.md" : "\"" + nearest + "\"";
  }

  bool read_line() {
    const std::string& label = words_[0];
    if (label == "END") {
      ended_ = true;
      return words_.size() == 1;
    }
    if (label == "METHOD") {
      file_.method = words_.size() > 1 ? words_[1] : "";
      return words_.size() == 2;
    }
    if (label == "MASS") return words_.size() == 2 && parse(words_[1], file_.mass);
    if (label == "MODE") return read_mode();
    if (label == "SNODE") {
      int id = 0;
      return size() && words_.size() == 2 && parse(words_[1], id) && special_nodes_.add(id, num_special_) >= 0;
    }
    if (const auto found = get_labels().find(label); found != get_labels().end()) return read_values(found->second);
    const std::map<std::string, int*> integers{{"BODY", &file_.body_id},  {"MODOPT", &file_.modopt},
                                               {"DIGITS", &file_.digits}, {"NMODE", &num_modes_},
                                               {"NNODE", &num_nodes_},    {"NSPECIAL", &num_special_}};
    const auto integer = integers.find(label);
    if (integer == integers.end() || words_.size() != 2 || !parse(words_[1], *integer->second)) return false;
    if (label == "MODOPT") return file_.modopt >= 0 && file_.modopt <= 2;
    if (label == "DIGITS") return file_.digits >= 2 && file_.digits <= 17;
    if (label != "BODY") return *integer->second >= 0 && *integer->second <= kMostCount && !is_sized_;
    return true;
  }

  /// Makes room once the counts are known.
  bool size() {
    if (is_sized_) return true;
    if (num_modes_ < 0 || num_nodes_ < 0 || num_special_ < 0) return false;
    // A damaged count must not ask for memory that the file could never fill: each value takes two bytes or more.
    const double modes = num_modes_, nodes = static_cast<double>(num_nodes_) + num_special_;
    std::error_code failed;
    const auto bytes = static_cast<double>(std::filesystem::file_size(path_, failed));
    if (failed || modes * modes + modes * nodes + nodes > bytes) return false;
    is_sized_ = true;
    const int n = num_modes_;
    file_.modes.assign(static_cast<std::size_t>(n), 0);
    for (auto* m : {&file_.M, &file_.K, &file_.D}) m->setConstant(n, n, kUnset);
    for (auto* m : {&file_.alpha, &file_.integrals.gamma1}) m->setConstant(3, n, kUnset);
    const records::Matrix3d unset = records::Matrix3d::Constant(kUnset);
    const auto count = static_cast<std::size_t>(n);
    if (file_.has_gamma23()) {
      file_.integrals.gamma2.assign(count, MatrixXd::Constant(3, n, kUnset));
      file_.integrals.gamma3.assign(count, unset);
    }
    if (file_.has_gamma4()) file_.integrals.gamma4.assign(count, std::vector<records::Matrix3d>(count, unset));
    file_.node_xyz.setConstant(num_nodes_, 3, kUnset);
    file_.gains.assign(static_cast<std::size_t>(num_nodes_), MatrixXd::Constant(6, n, kUnset));
    file_.special_gains.assign(static_cast<std::size_t>(num_special_), MatrixXd::Constant(6, n, kUnset));
    return true;
  }

  bool read_mode() {
    int j = 0, number = 0;
    if (!size() || words_.size() != 3 || !parse(words_[1], j) || !parse(words_[2], number)) return false;
    if (j < 1 || j > num_modes_) return false;
    file_.modes[static_cast<std::size_t>(j - 1)] = number;
    return true;
  }

  /// Nodes in their order, found by id.
  struct NodeList {
    std::vector<int>& ids;
    std::unordered_map<int, int> position = {};
    /// -1 when it is not there.
    int find(int id) const {
      const auto found = position.find(id);
      return found == position.end() ? -1 : found->second;
    }
    /// -1 when it is there already, or the list is full.
    int add(int id, int most) {
      const int next = static_cast<int>(ids.size());
      if (next >= most || !position.emplace(id, next).second) return -1;
      ids.push_back(id);
      return next;
    }
  };

  bool read_values(const Label& label) {
    if (!size()) return false;
    std::vector<int> at;
    std::size_t w = 1;
    for (char kind : label.shape) {
      int index = 0;
      if (w == words_.size() || !parse(words_[w++], index)) return false;
      if (kind == 'm') {
        index = nodes_.add(index, num_nodes_);
      } else if (kind == 'n') {
        index = nodes_.find(index);
      } else if (kind == 's') {
        index = special_nodes_.find(index);
      } else {
        --index;
        if (index >= (kind == 'a' ? 3 : num_modes_)) return false;
      }
      if (index < 0) return false;
      at.push_back(index);
    }
    const auto num_values = static_cast<int>(words_.size() - w);
    const bool is_left_out = (!file_.has_gamma23() && (words_[0] == "GAMMA2" || words_[0] == "GAMMA3")) ||
                             (!file_.has_gamma4() && words_[0] == "GAMMA4");
    if (is_left_out || num_values == 0 || (label.runs ? at[1] + num_values > num_modes_ : num_values != 3))
      return false;
    for (int v = 0; v < num_values; ++v) {
      double value = 0;
      if (!parse(words_[w + static_cast<std::size_t>(v)], value) || !std::isfinite(value)) return false;
      *label.place(at, v) = value;
    }
    return true;
  }

  void check(const char* label, bool is_complete) {
    if (!is_complete)
      diagnostics_.error("flx.missing-block", {path_}, std::string("values of ") + label + " are missing",
                         "write the file again");
  }

  void check_complete() {
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

  std::string path_;
  std::ifstream in_;
  FlxFile file_;
  Diagnostics diagnostics_;
  NodeList nodes_{file_.node_id}, special_nodes_{file_.special_id};
  std::map<std::string, Label> labels_;
  std::vector<std::string> words_;
  int line_ = 0, num_modes_ = -1, num_nodes_ = -1, num_special_ = -1;
  bool is_sized_ = false, ended_ = false;
};

}  // namespace

FlxFile read_flx(const std::string& path) { return FlxReader(path).read(); }

}  // namespace bough::flx
