#include <cstdio>

#include "formats/sid/sid.hpp"

namespace bough::sid {

namespace {

using Eigen::Index;

enum Structure { kZero = 0, kDiagonal = 1, kFull = 3, kUnit = 4 };

bool is_zero(const std::vector<MatrixXd>& m1) {
  for (const auto& m : m1)
    if (!m.isZero(0)) return false;
  return true;
}

Structure find_structure(const Taylor& t) {
  if (!is_zero(t.m1)) return kFull;
  if (t.m0.isZero(0)) return kZero;
  if (t.m0.rows() != t.m0.cols()) return kFull;
  if (t.m0 == MatrixXd::Identity(t.m0.rows(), t.m0.cols())) return kUnit;
  const MatrixXd diagonal = t.m0.diagonal().asDiagonal();
  return t.m0 == diagonal ? kDiagonal : kFull;
}

class Writer {
 public:
  Writer(int num_modes, int digits) : num_modes_(num_modes), digits_(digits) {}

  void put_line(int indent, const std::string& text) { text_ += std::string(std::size_t(indent), ' ') + text + "\n"; }

  /// The name fills up to the column of the equal sign.
  void put(int indent, std::string name, const std::string& value) {
    name.resize(std::max(name.size(), std::size_t(48 - indent)), ' ');
    put_line(indent, name + "=" + value);
  }
  void put(int indent, const std::string& name, int value) { put(indent, name, print("%6d", value)); }
  void put(int indent, const std::string& name, double value) { put(indent, name, print_real(value)); }

  void put(int indent, const std::string& name, const Taylor& t) {
    constexpr int kItem = 26;
    const auto structure = find_structure(t);
    put_line(indent, name);
    put(kItem, "order", t.m1.empty() ? 0 : 1);
    put(kItem, "nrow", static_cast<int>(t.m0.rows()));
    put(kItem, "ncol", static_cast<int>(t.m0.cols()));
    put(kItem, "nq", num_modes_);
    put(kItem, "nqn", 0);
    put(kItem, "structure", static_cast<int>(structure));
    if (structure != kUnit) {
      for (Index i = 0; i < t.m0.rows(); ++i)
        for (Index j = 0; j < t.m0.cols(); ++j)
          if (t.m0(i, j) != 0) put(kItem, print("m0(%2d,%2d)", int(i + 1), int(j + 1)), t.m0(i, j));
      for (Index j = 0; j < t.m0.cols(); ++j)
        for (Index i = 0; i < t.m0.rows(); ++i)
          for (std::size_t q = 0; q < t.m1.size(); ++q)
            if (t.m1[q](i, j) != 0)
              put(kItem, print("m1(%2d,%2d,%2d)", int(i + 1), int(q + 1), int(j + 1)), t.m1[q](i, j));
    }
    put_line(indent, "end " + name);
  }

  template <class... T>
  static std::string print(const char* format, T... values) {
    char text[96];
    std::snprintf(text, sizeof text, format, values...);
    return text;
  }

  std::string take() { return std::move(text_); }

 private:
  /// Fortran's D exponent.
  std::string print_real(double value) const {
    auto text = print("% .*E", digits_ - 1, value);
    if (const auto e = text.find('E'); e != std::string::npos) text[e] = 'D';
    return text;
  }

  int num_modes_, digits_;
  std::string text_;
};

}  // namespace

std::string write_sid(const Sid& sid, const Layout& layout) {
  const int n = sid.num_modes();
  Writer out(n, layout.digits);
  out.put_line(0, Writer::print("%5d %3d  :", int(sid.nodes.size()), n) + sid.comment);
  out.put_line(1, "part");
  out.put(6, "new modal", "");
  out.put_line(11, "refmod");
  out.put(16, "mass", sid.mass);
  out.put(16, "nelastq", n);
  for (int j = 0; j < n; ++j) out.put(16, Writer::print("ielastq (%4d)", j + 1), " " + sid.mode_name[std::size_t(j)]);
  out.put_line(11, "end refmod");
  out.put_line(11, "frame");
  for (const auto& node : sid.nodes) {
    out.put(16, "new node", " " + node.id);
    out.put(21, "rframe", "    body ref");
    out.put(21, "origin", node.origin);
    out.put(21, "phi", node.phi);
    out.put(21, "psi", node.psi);
    out.put(21, "AP", node.AP);
    out.put_line(16, "end node");
  }
  out.put_line(11, "end frame");
  const std::pair<const char*, const Taylor*> blocks[] = {
      {"mdCM", &sid.mdCM}, {"J", &sid.J},   {"Ct", &sid.Ct},         {"Cr", &sid.Cr}, {"Me", &sid.Me}, {"Gr", &sid.Gr},
      {"Ge", &sid.Ge},     {"Oe", &sid.Oe}, {"ksigma", &sid.ksigma}, {"Ke", &sid.Ke}, {"De", &sid.De}};
  for (const auto& [name, taylor] : blocks) out.put(11, name, *taylor);
  out.put_line(6, "end modal");
  out.put_line(1, "end part");
  return out.take();
}

}  // namespace bough::sid
