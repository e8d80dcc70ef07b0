#include <cmath>
#include <functional>

#include "base/diagnostic.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/records/mode_kind.hpp"

namespace bough::flx {

namespace {

/// Values of the indices i j k a b d l e, 0-based.
struct Indices {
  int i = 0, j = 0, k = 0, a = 0, b = 0, d = 0, l = 0, e = 0;
  int& operator[](char name) {
    switch (name) {
      case 'i':
        return i;
      case 'j':
        return j;
      case 'k':
        return k;
      case 'a':
        return a;
      case 'b':
        return b;
      case 'l':
        return l;
      case 'e':
        return e;
      default:
        return d;
    }
  }
};

class FlxWriter {
 public:
  FlxWriter(const FlxFile& file, const Layout& layout) : file_(file), layout_(layout) {}

  std::string write() {
    write_statements(layout_.statements);
    return std::move(text_);
  }

 private:
  int num_output() const { return static_cast<int>(file_.node_id.size()); }
  int num_special() const { return static_cast<int>(file_.special_id.size()); }
  int num_locators() const { return static_cast<int>(file_.more.locators.size()); }

  /// First and last + 1 of an index; nodes count through output and special ones.
  std::pair<int, int> get_range(char index, NodeSet nodes) const {
    switch (index) {
      case 'i':
        return {nodes == NodeSet::Special ? num_output() : 0,
                nodes == NodeSet::Output ? num_output() : num_output() + num_special()};
      case 'j':
      case 'k':
        return {0, file_.num_modes()};
      case 'd':
        return {0, 6};
      case 'l':
        return {0, file_.has_stiffening ? records::kNumInertialLoads : 0};
      case 'e':
        return {0, num_locators()};
      default:
        return {0, 3};
    }
  }

  int get_node(int i) const {
    return i < num_output() ? file_.node_id[static_cast<std::size_t>(i)]
                            : file_.special_id[static_cast<std::size_t>(i - num_output())];
  }
  const MatrixXd& get_gains(int i) const {
    return i < num_output() ? file_.gains[static_cast<std::size_t>(i)]
                            : file_.special_gains[static_cast<std::size_t>(i - num_output())];
  }

  /// Integrals that modopt leaves out, and what the extension of this body lacks, are not written.
  bool has(const Statement& s) const {
    if (s.name == "gamma2" || s.name == "gamma3") return file_.has_gamma23();
    if (s.name == "gamma4") return file_.has_gamma4();
    if (s.name == "cg" || s.name == "inertia") return meets("rigid");
    if (s.name == "kg_inertial" || s.name == "kg_external" || s.name == "external_load") return meets("stiffening");
    if (s.name == "load_resultant" || s.name == "load_moment") return meets("resultants");
    if (s.name == "kg_preload" || s.name == "preload_factor") return meets("preload");
    return true;
  }

  /// The condition of a `when`.
  bool meets(const std::string& condition) const {
    if (condition == "rigid") return file_.has_rigid;
    if (condition == "stiffening") return file_.has_stiffening;
    if (condition == "resultants") return file_.has_stiffening && file_.more.load_resultant.size() > 0;
    BOUGH_DEMAND(condition == "preload");
    return file_.has_stiffening && !file_.more.preload.empty();
  }

  double get_value(const std::string& name, const Indices& at) const {
    const auto j = static_cast<std::size_t>(at.j), k = static_cast<std::size_t>(at.k);
    const auto& g = file_.integrals;
    if (name == "mass") return file_.M(at.j, at.k);
    if (name == "stiffness") return file_.K(at.j, at.k);
    if (name == "damping") return file_.D(at.j, at.k);
    if (name == "mass_diagonal") return file_.M(at.j, at.j);
    if (name == "stiffness_diagonal") return file_.K(at.j, at.j);
    if (name == "damping_diagonal") return file_.D(at.j, at.j);
    if (name == "alpha") return file_.alpha(at.a, at.j);
    if (name == "gamma0") return g.gamma0(at.a, at.j);
    if (name == "gamma1") return g.gamma1(at.a, at.j);
    if (name == "gamma2") return g.gamma2[j](at.a, at.k);
    if (name == "gamma3") return g.gamma3[j](at.a, at.b);
    if (name == "gamma4") return g.gamma4[j][k](at.a, at.b);
    if (name == "node_xyz") return file_.node_xyz(at.i, at.a);
    if (name == "phi") return get_gains(at.i)(at.a, at.j);
    if (name == "psi") return get_gains(at.i)(3 + at.a, at.j);
    if (name == "gains") return get_gains(at.i)(at.d, at.j);
    return get_extension_value(name, at);
  }

  double get_extension_value(const std::string& name, const Indices& at) const {
    const auto& more = file_.more;
    const auto e = static_cast<std::size_t>(at.e);
    if (name == "cg") return more.cg[at.a];
    if (name == "inertia") return more.inertia(at.a, at.b);
    if (name == "kg_inertial") return more.kg_inertial[static_cast<std::size_t>(at.l)](at.j, at.k);
    if (name == "kg_external") return more.kg_external[e](at.j, at.k);
    if (name == "external_load") return more.external_load(at.j, at.e);
    if (name == "load_resultant") return more.load_resultant(at.d, at.e);
    if (name == "load_moment") return more.load_moment[e](at.a, at.j);
    if (name == "kg_preload") return more.kg_preload(at.j, at.k);
    BOUGH_DEMAND(name == "preload_factor");
    return more.preload_A_I[at.l];
  }

  [[noreturn]] void fail_width(const Statement& s, const std::string& what, double value) const {
    throw InputError("flx.number-too-wide", {layout_.file, s.line},
                     what + " does not fit its columns: " + std::to_string(value), "give the format more columns");
  }

  std::string print(const Statement& s, const NumberFormat& format, double value) const {
    if (!std::isfinite(value))
      throw InputError("flx.not-finite", {}, "a value of " + s.name + " is not a finite number",
                       "find out which step made it");
    const auto text = format.print(value);
    if (!text) fail_width(s, s.name, value);
    return *text;
  }
  std::string print_integer(const Statement& s, const NumberFormat& format, int value) const {
    const auto text = format.print_integer(value);
    if (!text) fail_width(s, s.name, value);
    return *text;
  }

  int get_integer(const std::string& field) {
    if (field.size() == 1) return at_[field[0]] + 1;
    if (field == "body_id") return file_.body_id;
    if (field == "modopt") return file_.modopt;
    if (field == "digits") return layout_.digits;
    if (field == "num_modes") return file_.num_modes();
    if (field == "num_nodes") return num_output();
    if (field == "num_special") return num_special();
    if (field == "num_locators") return num_locators();
    if (field == "locator_node") return file_.more.locators[static_cast<std::size_t>(at_.e)].node;
    if (field == "locator_direction") return file_.more.locators[static_cast<std::size_t>(at_.e)].direction;
    if (field == "node") return get_node(at_.i);
    if (field == "mode") return file_.modes[static_cast<std::size_t>(at_.j)];
    BOUGH_DEMAND(field == "mode_k");
    return file_.modes[static_cast<std::size_t>(at_.k)];
  }

  /// Text of a field that is no number; empty for the others.
  std::optional<std::string> get_words(const std::string& field) {
    if (field == "name") return file_.name;
    if (field == "method") return file_.method;
    if (field == "version") return file_.has_rigid || file_.has_stiffening ? "1.1" : "1.0";
    if (field == "frame") return file_.more.is_free_free ? "free" : "fixed";
    if (field == "preload") return file_.more.preload;
    if (field == "locator") return file_.more.locators[static_cast<std::size_t>(at_.e)].name;
    if (field == "kind")
      return file_.has_rigid ? records::get_name(file_.more.kind[static_cast<std::size_t>(at_.j)]) : "normal";
    if (field != "interface") return std::nullopt;
    std::string ids;
    for (const int id : file_.more.interface_nodes) ids += (ids.empty() ? "" : " ") + std::to_string(id);
    return ids;
  }

  std::string fill(const Statement& s, const TextTemplate& text) {
    std::string filled;
    for (const auto& piece : text.pieces) {
      filled += piece.plain;
      if (piece.field.empty()) continue;
      if (const auto words = get_words(piece.field)) {
        filled += *words;
      } else if (piece.field == "mass") {
        filled += print(s, piece.format ? *piece.format : s.number, file_.mass);
      } else {
        const int value = get_integer(piece.field);
        filled += piece.format ? print_integer(s, *piece.format, value) : std::to_string(value);
      }
    }
    return filled;
  }

  void write_statements(const std::vector<Statement>& statements) {
    for (const auto& s : statements) {
      if (s.kind == Statement::Kind::Text) {
        text_ += fill(s, s.text) + "\n";
      } else if (s.kind == Statement::Kind::For) {
        const auto [first, last] = get_range(s.name[0], s.nodes);
        for (int value = first; value < last; ++value) {
          at_[s.name[0]] = value;
          write_statements(s.body);
        }
      } else if (s.kind == Statement::Kind::When) {
        if (meets(s.name)) write_statements(s.body);
      } else if (has(s)) {
        write_block(s);
      }
    }
  }

  void write_block(const Statement& s) {
    for (const auto& [index, value] : s.fixed) {
      const auto [first, last] = get_range(index, s.nodes);
      if (first == last) return;
      if (first + value > last)
        throw InputError("flx.layout-index", {layout_.file, s.line},
                         "block " + s.name + " takes " + index + " = " + std::to_string(value) +
                             ", the body has 1 to " + std::to_string(last - first),
                         "correct the index");
      at_[index] = first + value - 1;
    }
    in_line_ = 0;
    is_first_ = true;
    begins_record_ = true;
    write_over(s, 0);
    end_line();
  }

  void end_line() {
    if (in_line_ > 0) text_ += "\n";
    in_line_ = 0;
  }

  /// The indices of the order from `depth` on, slowest first.
  void write_over(const Statement& s, std::size_t depth) {
    if (depth == s.order.size()) {
      write_value(s);
      return;
    }
    const auto [first, last] = get_range(s.order[depth], s.nodes);
    for (int value = first; value < last; ++value) {
      at_[s.order[depth]] = value;
      if (depth < s.record.size()) {
        end_line();
        begins_record_ = true;
      }
      write_over(s, depth + 1);
    }
  }

  void write_value(const Statement& s) {
    if ((s.triangle == 'u' && at_.k < at_.j) || (s.triangle == 'l' && at_.k > at_.j)) return;
    if (s.name == "node_xyz" && at_.i >= num_output()) return;  // special nodes have none
    if (s.name == "kg_inertial" && !file_.more.kg_inertial_computed[static_cast<std::size_t>(at_.l)]) return;
    if (is_first_ && s.has_heading) text_ += fill(s, s.heading) + "\n";
    is_first_ = false;
    if (s.per_line > 0 && in_line_ == s.per_line) end_line();
    const bool is_integer = s.name == "modes" || s.name == "node_id";
    const auto& format = is_integer ? s.integer : s.number;
    if (in_line_ == 0) {
      const std::string label = fill(s, begins_record_ ? s.text : s.continued);
      text_ += label;
      if (!label.empty() && !format.has_width() && s.separator.empty()) text_ += " ";
    } else {
      text_ += s.separator.empty() && !format.has_width() ? " " : s.separator;
    }
    begins_record_ = false;
    ++in_line_;
    if (s.name == "modes")
      text_ += print_integer(s, format, file_.modes[static_cast<std::size_t>(at_.j)]);
    else if (s.name == "node_id")
      text_ += print_integer(s, format, get_node(at_.i));
    else
      text_ += print(s, format, get_value(s.name, at_));
  }

  const FlxFile& file_;
  const Layout& layout_;
  std::string text_;
  Indices at_;
  int in_line_ = 0;
  bool is_first_ = true, begins_record_ = true;
};

}  // namespace

std::string write_flx(const FlxFile& file, const Layout& layout) { return FlxWriter(file, layout).write(); }

}  // namespace bough::flx
