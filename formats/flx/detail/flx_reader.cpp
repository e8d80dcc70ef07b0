#include "formats/flx/detail/flx_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "base/platform.hpp"

namespace bough::flx::detail {

namespace {

constexpr int kMaxCount = 1000000;
constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

template <class Number>
bool parse_all(const std::string& word, Number& value) {
  const auto [end, error] = platform::read_number(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

}  // namespace

bool parse_value(const std::string& word, double& value) { return parse_all(word, value); }
bool parse_value(const std::string& word, int& value) { return parse_all(word, value); }

std::vector<std::string> split_blanks(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

int NodeList::find(int id) const {
  const auto found = position.find(id);
  return found == position.end() ? -1 : found->second;
}

int NodeList::add(int id, int max_value) {
  const int next = static_cast<int>(ids.size());
  if (next >= max_value || !position.emplace(id, next).second) return -1;
  ids.push_back(id);
  return next;
}

void FlxReader::check_version(const std::vector<std::string>& first) {
  if (first.empty() || first[0] != "FLX")
    throw InputError("flx.not-flx", {path_, line_}, "the first line does not start with FLX",
                     "give a file that bough flx or bough integrals wrote without --layout");
  const std::string version = first.size() > 1 ? first[1] : "";
  if (version.rfind("1.", 0) != 0 || !parse_value(version.substr(2), minor_))
    throw InputError("flx.version", {path_, line_}, "the file has version " + version + ", expected 1.x",
                     "use a newer Bough");
}

FlxFile FlxReader::read(const std::vector<std::string>& first) {
  check_version(first);
  add_labels();
  add_extension_labels();
  std::error_code failed;
  bytes_ = static_cast<double>(std::filesystem::file_size(path_, failed));
  if (failed) bytes_ = 0;
  std::string line;
  while (!ended_ && std::getline(in_, line)) {
    ++line_;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    read_text_line(line);
  }
  if (!ended_)
    diagnostics_.error("flx.missing-block", {path_}, "the file ends without END", "write it again: it was cut");
  check_complete();
  if (file_.has_rigid || file_.has_stiffening) check_extension();
  diagnostics_.throw_if_errors();
  if (file_.integrals.gamma0.hasNaN()) file_.integrals.gamma0 = file_.mass * file_.alpha;
  return std::move(file_);
}

void FlxReader::read_text_line(const std::string& line) {
  words_ = split_blanks(line);
  if (words_.empty()) return;
  const auto fail = [&](const std::string& label) {
    diagnostics_.error("flx.bad-line", {path_, line_}, "cannot read the line with the label \"" + label + "\"",
                       "expected " + describe(label));
  };
  if (words_[0] == "!+" && minor_ > 0 && words_.size() > 1) {
    words_.erase(words_.begin());
    const std::string label = words_[0] = "!+" + words_[0];
    const bool is_known = labels_.count(label) > 0 || label == "!+FRAME" || label == "!+KIND" ||
                          label == "!+NLOCATOR" || label == "!+INTERFACE" || label == "!+LOCATOR" ||
                          label == "!+PRELOAD";
    // Additions of a later version are skipped, as a reader of 1.0 skips all of the extension.
    if (!is_known && minor_ > 1) return;
    if (!is_known || !read_extension(label, line)) fail(label);
  } else if (words_[0][0] == '!') {
    return;
  } else if (words_[0] == "NAME") {
    file_.name = line.size() > 5 ? line.substr(5) : "";
  } else if (!read_line()) {
    fail(words_[0]);
  }
}

bool FlxReader::read_line() {
  const std::string& label = words_[0];
  if (label == "END") {
    ended_ = true;
    return words_.size() == 1;
  }
  if (label == "METHOD") {
    file_.method = words_.size() > 1 ? words_[1] : "";
    return words_.size() == 2;
  }
  if (label == "MASS") return words_.size() == 2 && parse_value(words_[1], file_.mass);
  if (label == "MODE") return read_mode();
  if (label == "SNODE") {
    int id = 0;
    return size() && words_.size() == 2 && parse_value(words_[1], id) && special_nodes_.add(id, num_special_) >= 0;
  }
  if (const auto found = labels_.find(label); found != labels_.end()) return read_values(found->second);
  const std::map<std::string, int*> integers{{"BODY", &file_.body_id},  {"MODOPT", &file_.modopt},
                                             {"DIGITS", &file_.digits}, {"NMODE", &num_modes_},
                                             {"NNODE", &num_nodes_},    {"NSPECIAL", &num_special_}};
  const auto integer = integers.find(label);
  int value = 0;
  if (integer == integers.end() || words_.size() != 2 || !parse_value(words_[1], value)) return false;
  if (is_sized_ && label != "BODY" && label != "DIGITS") return false;  // what has its room keeps its counts
  *integer->second = value;
  if (label == "MODOPT") return file_.modopt >= 0 && file_.modopt <= 2;
  if (label == "DIGITS") return file_.digits >= 2 && file_.digits <= 17;
  if (label != "BODY") return *integer->second >= 0 && *integer->second <= kMaxCount;
  return true;
}

/// Makes room once the counts are known.
bool FlxReader::size() {
  if (is_sized_) return true;
  if (num_modes_ < 0 || num_nodes_ < 0 || num_special_ < 0) return false;
  // A damaged count must not ask for memory that the file could never fill: each value takes two bytes or more.
  const double modes = num_modes_, nodes = static_cast<double>(num_nodes_) + num_special_;
  if (modes * modes + modes * nodes + nodes > bytes_) return false;
  is_sized_ = true;
  const int n = num_modes_;
  const auto count = static_cast<std::size_t>(n);
  file_.modes.assign(count, 0);
  file_.more.kind.assign(count, records::ModeKind::Normal);
  for (auto* m : {&file_.M, &file_.K, &file_.D}) m->setConstant(n, n, kUnset);
  for (auto* m : {&file_.alpha, &file_.integrals.gamma0, &file_.integrals.gamma1}) m->setConstant(3, n, kUnset);
  const records::Matrix3d unset = records::Matrix3d::Constant(kUnset);
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

bool FlxReader::read_mode() {
  int j = 0, number = 0;
  if (!size() || words_.size() != 3 || !parse_value(words_[1], j) || !parse_value(words_[2], number)) return false;
  if (j < 1 || j > num_modes_) return false;
  file_.modes[static_cast<std::size_t>(j - 1)] = number;
  return true;
}

/// -1 when it is none.
int FlxReader::read_index(char kind, const std::string& word) {
  int index = 0;
  if (!parse_value(word, index)) return -1;
  if (kind == 'm') return nodes_.add(index, num_nodes_);
  if (kind == 'n') return nodes_.find(index);
  if (kind == 's') return special_nodes_.find(index);
  const int max_value = kind == 'a'   ? 3
                        : kind == 'l' ? records::kNumInertialLoads
                        : kind == 'e' ? num_locators_
                                      : num_modes_;
  return index >= 1 && index <= max_value ? index - 1 : -1;
}

bool FlxReader::read_values(const Label& label) {
  if (!size()) return false;
  std::vector<int> at;
  std::size_t w = 1;
  for (const char kind : label.shape) {
    const int index = w < words_.size() ? read_index(kind, words_[w++]) : -1;
    if (index < 0) return false;
    at.push_back(index);
  }
  const auto num_values = static_cast<int>(words_.size() - w);
  const bool is_left_out = (!file_.has_gamma23() && (words_[0] == "GAMMA2" || words_[0] == "GAMMA3")) ||
                           (!file_.has_gamma4() && words_[0] == "GAMMA4");
  if (is_left_out || num_values == 0) return false;
  if (label.runs ? at.back() + num_values > num_modes_ : num_values != label.count) return false;
  for (int v = 0; v < num_values; ++v) {
    double value = 0;
    if (!parse_value(words_[w + static_cast<std::size_t>(v)], value) || !std::isfinite(value)) return false;
    Slot slot = label.place(at, v);
    if (slot == nullptr) return false;
    *slot = value;
  }
  return true;
}

}  // namespace bough::flx::detail
