#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>

#include "base/file_roles.hpp"
#include "base/platform.hpp"
#include "formats/sid/sid.hpp"

namespace bough::sid {

namespace {

using Eigen::Index;

std::string trim(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), in_(path, std::ios::binary) {
    if (!in_) throw InputError("cli.no-file", {path}, "no such file, or not readable", "check the path");
    note_input(path);
  }

  Sid run() {
    next("the numbers of nodes and modes");
    const auto colon = line_.find(':');
    if (colon != std::string::npos) sid_.comment = trim(line_.substr(colon + 1));
    next("part");
    if (line_ != "part") fail("expected \"part\", found \"" + line_ + "\"");
    for (next("a block"); line_ != "end part"; next("end part")) read_item();
    check();
    return std::move(sid_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const char* id = "export.sid-syntax") const {
    throw InputError(id, {path_, number_}, what, "compare with docs/formats/sid.md");
  }

  /// The next line that is not blank, trimmed; "name = value" is split.
  void next(const std::string& expected) {
    do {
      if (!std::getline(in_, line_)) fail("the file ends, expected " + expected);
      ++number_;
      line_ = trim(line_);
    } while (line_.empty());
    const auto equals = line_.find('=');
    name_ = trim(line_.substr(0, equals));
    value_ = equals == std::string::npos ? "" : trim(line_.substr(equals + 1));
  }

  double get_real() const {
    std::string text = value_;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == 'D' || c == 'd'; }, 'E');
    if (!text.empty() && text.front() == '+') text.erase(0, 1);
    double value = 0;
    const auto [end, error] = platform::read_number(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) fail("expected a number, found \"" + value_ + "\"");
    return value;
  }
  int get_int() const {
    int value = 0;
    const auto [end, error] = platform::read_number(value_.data(), value_.data() + value_.size(), value);
    if (error != std::errc() || end != value_.data() + value_.size() || value < 0)
      fail("expected a whole number, found \"" + value_ + "\"");
    return value;
  }

  void read_item() {
    const std::map<std::string, Taylor*> blocks{{"mdCM", &sid_.mdCM}, {"J", &sid_.J},   {"Ct", &sid_.Ct},
                                                {"Cr", &sid_.Cr},     {"Me", &sid_.Me}, {"Gr", &sid_.Gr},
                                                {"Ge", &sid_.Ge},     {"Oe", &sid_.Oe}, {"ksigma", &sid_.ksigma},
                                                {"Ke", &sid_.Ke},     {"De", &sid_.De}};
    const auto block = blocks.find(line_);
    if (block != blocks.end()) {
      *block->second = read_taylor(block->first);
    } else if (line_ == "refmod") {
      read_refmod();
    } else if (line_ == "frame" || line_ == "new frame") {
      for (next("end frame"); line_ != "end frame"; next("end frame")) read_node();
    } else if (name_ != "new modal" && line_ != "end modal") {
      fail("unknown block \"" + line_ + "\"");
    }
  }

  void read_refmod() {
    int num_modes = 0;
    for (next("end refmod"); line_ != "end refmod"; next("end refmod")) {
      if (name_ == "mass")
        sid_.mass = get_real();
      else if (name_ == "nelastq")
        num_modes = get_int();
      else if (name_.rfind("ielastq", 0) == 0)
        sid_.mode_name.push_back(value_);
      else
        fail("unknown item \"" + name_ + "\" in refmod");
    }
    if (num_modes != sid_.num_modes())
      fail("nelastq is " + std::to_string(num_modes) + ", found " + std::to_string(sid_.num_modes()) + " ielastq",
           "export.sid-shape");
  }

  void read_node() {
    if (name_ != "new node") fail("expected \"new node\", found \"" + line_ + "\"");
    Node node;
    node.id = value_;
    for (next("end node"); line_ != "end node"; next("end node")) {
      const std::map<std::string, Taylor*> blocks{
          {"origin", &node.origin}, {"phi", &node.phi}, {"psi", &node.psi}, {"AP", &node.AP}};
      const auto block = blocks.find(line_);
      if (block != blocks.end())
        *block->second = read_taylor(block->first);
      else if (line_ == "sigma")
        read_taylor(line_);  // stresses: nothing here uses them
      else if (name_ != "rframe")
        fail("unknown block \"" + line_ + "\" in a node");
    }
    sid_.nodes.push_back(std::move(node));
  }

  /// order .. structure, then the entries; what is not listed is zero. Structure 2 lists one triangle, 4 may list none.
  Taylor read_taylor(const std::string& name) {
    std::map<std::string, int> head;
    Taylor taylor;
    const auto allocate = [&] {
      const int rows = head["nrow"], columns = head["ncol"];
      if (head["structure"] == 2 && rows != columns)
        fail("block " + name + " is symmetric (structure 2) with " + std::to_string(rows) + " rows and " +
                 std::to_string(columns) + " columns",
             "export.sid-shape");
      constexpr double kMaxValues = 1e8;
      if (static_cast<double>(rows) * columns * std::max(1, head["nq"]) > kMaxValues)
        fail("block " + name + " would have more than 1e8 entries", "export.sid-shape");
      taylor = head["order"] > 0 ? Taylor::zero(rows, columns, head["nq"]) : Taylor::zero(rows, columns);
    };
    bool lists_m0 = false;
    for (next("end " + name); line_ != "end " + name; next("end " + name)) {
      if (name_.rfind("m0", 0) == 0 || name_.rfind("m1", 0) == 0) {
        if (head.size() != 6) fail(name + " has no order, nrow, ncol, nq, nqn and structure before its entries");
        lists_m0 = lists_m0 || name_[1] == '0';
        set_entry(taylor, head["structure"] == 2);
        continue;
      }
      static const std::vector<std::string> known{"order", "nrow", "ncol", "nq", "nqn", "structure"};
      if (std::find(known.begin(), known.end(), name_) == known.end())
        fail("unknown item \"" + name_ + "\" in " + name);
      head[name_] = get_int();
      if (head.size() == 6) allocate();
    }
    if (head.size() != 6) fail(name + " has no order, nrow, ncol, nq, nqn and structure");
    if (head["structure"] == 4 && !lists_m0) taylor.m0.setIdentity();
    return taylor;
  }

  /// "m0( i, j)" or "m1( i, q, j)".
  void set_entry(Taylor& taylor, bool is_symmetric) {
    int index[3] = {}, count = 0;
    for (const char* at = name_.c_str() + 2; *at; ++at) {
      if (*at >= '0' && *at <= '9') {
        if (count == 3) fail("too many indices in " + name_);
        for (; *at >= '0' && *at <= '9'; ++at) index[count] = 10 * std::min(index[count], 100000) + (*at - '0');
        ++count;
        --at;
      }
    }
    const bool is_first = name_[1] == '1';
    if (count != (is_first ? 3 : 2))
      fail("expected " + std::string(is_first ? "three" : "two") + " indices in " + name_);
    const int row = index[0], q = is_first ? index[1] : 1, column = index[count - 1];
    const auto outside = [](int i, Index size) { return i < 1 || i > size; };
    if (outside(row, taylor.m0.rows()) || outside(column, taylor.m0.cols()) ||
        (is_first && outside(q, static_cast<Index>(taylor.m1.size()))))
      fail(name_ + " lies outside of the block", "export.sid-shape");
    MatrixXd& m = is_first ? taylor.m1[static_cast<std::size_t>(q - 1)] : taylor.m0;
    m(row - 1, column - 1) = get_real();
    if (is_symmetric) m(column - 1, row - 1) = m(row - 1, column - 1);
  }

  void check() const {
    const int n = sid_.num_modes();
    const auto demand = [&](const std::string& name, const Taylor& t, int rows, int columns) {
      if (t.m0.size() == 0 && rows * columns > 0) fail("block " + name + " is not there", "export.sid-missing");
      if (t.m0.rows() != rows || t.m0.cols() != columns || (!t.m1.empty() && static_cast<int>(t.m1.size()) != n))
        fail("block " + name + " is " + std::to_string(t.m0.rows()) + " x " + std::to_string(t.m0.cols()) +
                 ", expected " + std::to_string(rows) + " x " + std::to_string(columns) + " and " + std::to_string(n) +
                 " modes",
             "export.sid-shape");
    };
    demand("mdCM", sid_.mdCM, 3, 1);
    demand("J", sid_.J, sid_.J.m0.cols() == 3 ? 3 : 6, sid_.J.m0.cols() == 3 ? 3 : 1);
    demand("Ct", sid_.Ct, n, 3);
    demand("Cr", sid_.Cr, n, 3);
    demand("Me", sid_.Me, n, n);
    demand("Gr", sid_.Gr, 3, 3 * n);
    demand("Ge", sid_.Ge, n, 3 * n);
    demand("Oe", sid_.Oe, n, 6);
    demand("ksigma", sid_.ksigma, n, 1);
    demand("Ke", sid_.Ke, n, n);
    demand("De", sid_.De, n, n);
    for (const auto& node : sid_.nodes) {
      demand("origin of node " + node.id, node.origin, 3, 1);
      demand("phi of node " + node.id, node.phi, 3, n);
      demand("psi of node " + node.id, node.psi, 3, n);
      demand("AP of node " + node.id, node.AP, 3, 3);
    }
  }

  std::string path_;
  std::ifstream in_;
  std::string line_, name_, value_;
  int number_ = 0;
  Sid sid_;
};

}  // namespace

Sid read_sid(const std::string& path) { return Reader(path).run(); }

}  // namespace bough::sid
