#include "modal/response/recovery.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "fe/elements/spring_rows.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/statics/element_groups.hpp"
#include "fe/statics/element_results.hpp"

namespace bough::modal::response {
namespace {

using namespace std::complex_literals;

/// u = W z with z = [q; d].
MatrixXd join_shapes(const ResponseModel& r) {
  MatrixXd W(r.Phi.rows(), r.Phi.cols() + r.Psi.cols());
  W << r.Phi, r.Psi;
  return W;
}

struct Rows {
  std::vector<std::pair<int, int>> dofs;
  std::vector<int> gdofs;  ///< rows in CD axes
};

Rows list_rows(const fe::Model& model, const std::vector<int>& grids) {
  Rows rows;
  for (const int id : grids) {
    const auto& node = model.node(model.find_node(id));
    for (int c = 0; c < node.num_dofs; ++c) {
      rows.dofs.emplace_back(id, node.num_dofs == 1 ? 0 : c + 1);
      rows.gdofs.push_back(node.first_gdof + c);
    }
  }
  return rows;
}

/// Rows of U (g-set, basic) in CD axes.
MatrixXd pick_rows(const fe::Model& model, const std::vector<int>& gdofs, MatrixXd U) {
  for (Eigen::Index c = 0; c < U.cols(); ++c) turn_to_cd(model, U.col(c));
  return U(gdofs, Eigen::all);
}

/// Forces Y (g-set) at the supports, by row (CD axes); 0 at unconstrained components.
MatrixXd pick_held(const fe::Model& model, const MatrixXd& Y, const std::vector<int>& gdofs) {
  const auto& fixed = model.fixed_dofs();
  const MatrixXd held = model.T_fixed().transpose() * Y;
  MatrixXd rows = MatrixXd::Zero(static_cast<Eigen::Index>(gdofs.size()), Y.cols());
  for (std::size_t i = 0; i < gdofs.size(); ++i)
    if (const auto at = std::lower_bound(fixed.begin(), fixed.end(), gdofs[i]); at != fixed.end() && *at == gdofs[i])
      rows.row(static_cast<Eigen::Index>(i)) = held.row(at - fixed.begin());
  return rows;
}

/// Results of the chosen elements of one card, all components of one after the other.
struct ElementGroup {
  std::string name;  ///< of fe::ElementGroup
  std::vector<std::string> components;
  std::vector<const fe::Element*> elements;
  bool of_stress = false;
  bool is_derived = false;  ///< stresses over time: with von Mises and the like

  /// Rows: (elements x components), of motions U (g-set, basic).
  MatrixXd calc(const MatrixXd& U) const {
    const auto num = count_linear();
    MatrixXd values(num * static_cast<Eigen::Index>(elements.size()), U.cols());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      auto rows = values.middleRows(num * static_cast<Eigen::Index>(e), num);
      if (of_stress) {
        rows = elements[e]->stress_recovery()->calc_stresses(fe::calc_internal_forces(*elements[e], U));
        continue;
      }
      const MatrixXd U_e = U(elements[e]->gdofs(), Eigen::all);
      const fe::PrintedForces& forces = *elements[e]->printed_forces();
      for (Eigen::Index c = 0; c < U.cols(); ++c) rows.col(c) = forces.calc_printed_forces(U_e.col(c));
    }
    return values;
  }

  MatrixXd derive(const MatrixXd& values) const {
    if (!is_derived) return values;
    const auto from = count_linear(), to = static_cast<Eigen::Index>(components.size());
    MatrixXd results(to * static_cast<Eigen::Index>(elements.size()), values.cols());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const auto points = elements[e]->stress_recovery()->stress_points();
      const auto at = static_cast<Eigen::Index>(e);
      for (Eigen::Index c = 0; c < values.cols(); ++c)
        results.col(c).segment(at * to, to) = fe::calc_stress_results(points, values.col(c).segment(at * from, from));
    }
    return results;
  }
  static MatrixXcd derive(const MatrixXcd& values) { return values; }

 private:
  Eigen::Index count_linear() const {
    if (!is_derived) return static_cast<Eigen::Index>(components.size());
    return static_cast<Eigen::Index>(
        fe::list_stress_names(elements.front()->stress_recovery()->stress_points()).size());
  }
};

std::vector<std::string> list_stress_components(const fe::Element& element, bool is_derived) {
  if (!element.stress_recovery()) return {};
  const auto points = element.stress_recovery()->stress_points();
  if (is_derived) return fe::list_result_names(points);
  std::vector<std::string> names;
  for (const auto& name : fe::list_stress_names(points)) names.push_back(name.substr(std::string("stress_").size()));
  return names;
}

std::vector<ElementGroup> list_groups(const fe::Model& model, const std::vector<int>& chosen, bool of_stress,
                                      bool is_over_time) {
  const std::set<int> requested(chosen.begin(), chosen.end());
  const auto found = fe::group_elements(model, [&](const fe::Element& element, int) {
    if (requested.count(element.id()) == 0) return std::vector<std::string>{};
    // Groups of static results in both domains.
    return of_stress ? list_stress_components(element, true) : fe::list_force_components(element);
  });
  std::vector<ElementGroup> groups;
  for (const auto& [name, components, members] : found) {
    auto& group = groups.emplace_back();
    group.name = name;
    for (const int e : members) group.elements.push_back(model.elements()[static_cast<std::size_t>(e)].get());
    group.components = of_stress ? list_stress_components(*group.elements.front(), is_over_time) : components;
    group.of_stress = of_stress;
    group.is_derived = of_stress && is_over_time;
  }
  return groups;
}

using LinearMap = std::function<MatrixXd(const MatrixXd&)>;
/// A linear map of the motion u (order 0), of u̇ or ü; motions are on the g-set, basic.
template <class Values>
using Apply = std::function<Values(const LinearMap& map, int order)>;

void store(const MatrixXcd& values, MatrixXd& real, MatrixXd& imag) {
  real = values.real().transpose();
  imag = values.imag().transpose();
}
void store(const MatrixXd& values, MatrixXd& real, MatrixXd&) { real = values.transpose(); }

MatrixXcd times_i(const MatrixXcd& values) { return 1i * values; }
MatrixXd times_i(const MatrixXd& values) { return MatrixXd::Zero(values.rows(), values.cols()); }

/// Appends the rows of `more` to `all`; copies `more` if `all` is empty.
void append_rows(const MatrixXd& more, MatrixXd& all) {
  if (all.size() == 0) {
    all = more;
    return;
  }
  all.conservativeResize(all.rows() + more.rows(), Eigen::NoChange);
  all.bottomRows(more.rows()) = more;
}

/// Samples of one call stand below those of the calls before.
class Recovery {
 public:
  Recovery(const fe::Model& model, const Excitation& excitation, const DampingChoice& damping,
           const std::vector<OutputChoice>& outputs, const FrequencyTables* tables = nullptr)
      : model_(model), excitation_(excitation), damping_(damping), outputs_(outputs), tables_(tables) {}

  template <class Values>
  void add(const VectorXd& x, const Apply<Values>& apply, const Values& p, records::ResponseSubcase& result) const {
    const auto before = result.x.size();
    result.x.conservativeResize(before + x.size());
    result.x.tail(x.size()) = x;
    const bool is_first = before == 0;
    std::size_t at = 0, at_element = 0, at_listed = 0;
    for (const auto& output : outputs_) {
      const bool of_stress = output.quantity == "stress";
      if (of_stress || output.quantity == "force") {
        for (const auto& group : list_groups(model_, output.ids, of_stress, damping_.is_over_time)) {
          auto& into = output.is_for_listing ? result.listed_forces : result.elements;
          if (is_first) into.push_back(begin_curves(group, output));
          Values values = apply([&](const MatrixXd& U) { return group.calc(U); }, 0);
          if (!of_stress) add_table_forces(group, x, apply, values);
          append(Values(group.derive(values)), into[output.is_for_listing ? at_listed++ : at_element++]);
        }
        continue;
      }
      const auto rows = list_rows(model_, output.ids);
      if (is_first)
        result.curves.push_back(
            {output.quantity, rows.dofs, {}, {}, output.is_phase, output.is_punched, output.is_printed});
      append(calc<Values>(output.quantity, rows, x, apply, p), result.curves[at++]);
    }
  }

 private:
  static records::ElementCurves begin_curves(const ElementGroup& group, const OutputChoice& output) {
    records::ElementCurves curves;
    curves.card = group.name;
    curves.components = group.components;
    for (const auto* element : group.elements) curves.ids.push_back(element->id());
    curves.is_phase = output.is_phase;
    curves.is_punched = output.is_punched;
    curves.is_printed = output.is_printed;
    curves.is_stress = group.of_stress;
    return curves;
  }

  template <class Values, class Curves>
  static void append(const Values& values, Curves& curves) {
    MatrixXd real, imag;
    store(values, real, imag);
    append_rows(real, curves.real);
    append_rows(imag, curves.imag);
  }

  template <class Values>
  Values calc(const std::string& quantity, const Rows& rows, const VectorXd& x, const Apply<Values>& apply,
              const Values& p) const {
    if (quantity != "spc_force") {
      const int order = quantity == "velocity" ? 1 : quantity == "acceleration" ? 2 : 0;
      return apply([&](const MatrixXd& U) { return pick_rows(model_, rows.gdofs, U); }, order);
    }
    const auto pick = [&](const MatrixXd& Y) { return pick_held(model_, Y, rows.gdofs); };
    const auto K = [&](const MatrixXd& U) { return pick(fe::calc_stiffness_times(model_, U)); };
    const auto S = [&](const MatrixXd& U) { return pick(times_structural(model_, damping_, U)); };
    const auto B = [&](const MatrixXd& U) { return pick(times_damping(model_, damping_, U)); };
    const auto M = [&](const MatrixXd& U) { return pick(fe::calc_mass_times(model_, model_.mass_kind(), U)); };
    Values force = apply(K, 0) + apply(B, 1) + apply(M, 2) - pick(excitation_.F) * p;
    if (!damping_.is_over_time) force += times_i(apply(S, 0));
    add_table_reactions(rows, x, apply, force);
    return force;
  }

  /// Adds (k(f) - k) times the elongations of the springs of the group.
  void add_table_forces(const ElementGroup& group, const VectorXd& hz, const Apply<MatrixXcd>& apply,
                        MatrixXcd& values) const {
    if (tables_ == nullptr || group.elements.empty()) return;
    const auto num = values.rows() / static_cast<Eigen::Index>(group.elements.size());
    for (std::size_t e = 0; e < group.elements.size(); ++e) {
      const auto& element = *group.elements[e];
      if (tables_->calc_force_change(element, 0).size() == 0) continue;
      const MatrixXd S = dynamic_cast<const fe::SpringRows&>(element).calc_spring_rows();
      const MatrixXcd stretch =
          apply([&](const MatrixXd& U) -> MatrixXd { return S * U(element.gdofs(), Eigen::all); }, 0);
      for (Eigen::Index i = 0; i < hz.size(); ++i)
        values.col(i).segment(num * static_cast<Eigen::Index>(e), num) +=
            tables_->calc_force_change(element, hz(i)).cwiseProduct(stretch.col(i));
    }
  }
  void add_table_forces(const ElementGroup&, const VectorXd&, const Apply<MatrixXd>&, MatrixXd&) const {}

  /// Adds Z(f) u at the supports.
  void add_table_reactions(const Rows& rows, const VectorXd& hz, const Apply<MatrixXcd>& apply,
                           MatrixXcd& force) const {
    if (tables_ == nullptr) return;
    MatrixXcd stretch = apply([&](const MatrixXd& U) -> MatrixXd { return tables_->directions().transpose() * U; }, 0);
    for (Eigen::Index i = 0; i < hz.size(); ++i)
      stretch.col(i) = stretch.col(i).cwiseProduct(tables_->calc_stiffness(hz(i))).eval();
    force += pick_held(model_, MatrixXd(tables_->directions()), rows.gdofs) * stretch;
  }
  void add_table_reactions(const Rows&, const VectorXd&, const Apply<MatrixXd>&, MatrixXd&) const {}

  const fe::Model& model_;
  const Excitation& excitation_;
  const DampingChoice& damping_;
  const std::vector<OutputChoice>& outputs_;
  const FrequencyTables* tables_;
};

template <class Values>
Values stack(const Values& q, const Values& d) {
  Values z(q.rows() + d.rows(), q.cols());
  z << q, d;
  return z;
}

/// Recovery by modes: u = W z.
template <class Values>
Apply<Values> make_apply(const MatrixXd& W, const std::array<Values, 3>& z) {
  return [&](const LinearMap& map, int order) -> Values { return map(W) * z[static_cast<std::size_t>(order)]; };
}

MatrixXd apply_to(const LinearMap& map, const MatrixXd& u) { return map(u); }
MatrixXcd apply_to(const LinearMap& map, const MatrixXcd& u) {
  MatrixXcd values = map(u.real()).cast<std::complex<double>>();
  values.imag() = map(u.imag());
  return values;
}

template <class Values>
void add_motion(const Recovery& recovery, const MotionBlock<Values>& motion, records::ResponseSubcase& result) {
  const std::array<const Values*, 3> of{&motion.u, &motion.u_dot, &motion.u_ddot};
  const Apply<Values> apply = [&](const LinearMap& map, int order) {
    return apply_to(map, *of[static_cast<std::size_t>(order)]);
  };
  recovery.add<Values>(motion.x, apply, motion.p, result);
}

}  // namespace

std::vector<CoordinateMap> make_coordinate_maps(const fe::Model& model, const ResponseModel& response,
                                                const Excitation& excitation, const DampingChoice& damping,
                                                const std::vector<OutputChoice>& outputs) {
  const MatrixXd W = join_shapes(response);
  const auto n = W.cols(), m = excitation.F.cols();
  // A column per coordinate of u, of u̇, of ü, and per force.
  const Apply<MatrixXcd> apply = [&](const LinearMap& map, int order) {
    const MatrixXd rows = map(W);
    MatrixXcd values = MatrixXcd::Zero(rows.rows(), 3 * n + m);
    values.middleCols(order * n, n) = rows.cast<std::complex<double>>();
    return values;
  };
  MatrixXcd p = MatrixXcd::Zero(m, 3 * n + m);
  p.rightCols(m).setIdentity();
  records::ResponseSubcase columns;
  Recovery(model, excitation, damping, outputs).add<MatrixXcd>(VectorXd::LinSpaced(3 * n + m, 0, 1), apply, p, columns);
  std::vector<CoordinateMap> maps;
  const auto add = [&](const auto& curves) {
    MatrixXcd all(curves.real.cols(), curves.real.rows());
    all.real() = curves.real.transpose();
    all.imag() = curves.imag.transpose();
    CoordinateMap map;
    for (int order = 0; order < 3; ++order) {
      MatrixXcd block = MatrixXcd::Zero(all.rows(), n + m);
      block.leftCols(n) = all.middleCols(order * n, n);
      if (order == 0) block.rightCols(m) = all.rightCols(m);
      if (!block.isZero(0)) map.motion[static_cast<std::size_t>(order)] = std::move(block);
    }
    maps.push_back(std::move(map));
  };
  for (const auto& curves : columns.curves) add(curves);
  for (const auto& curves : columns.elements) add(curves);
  return maps;
}

void recover(const fe::Model& model, const ResponseModel& response, const Excitation& excitation,
             const DampingChoice& damping, const std::vector<OutputChoice>& outputs, const Spectrum& spectrum,
             const FrequencyTables* tables, records::ResponseSubcase& result) {
  const MatrixXd W = join_shapes(response);
  const Eigen::RowVectorXcd rate = 2i * std::numbers::pi * spectrum.hz.transpose().cast<std::complex<double>>();
  std::array<MatrixXcd, 3> z;
  z[0] = stack<MatrixXcd>(spectrum.q, spectrum.d);
  z[1] = z[0] * rate.asDiagonal();
  z[2] = z[1] * rate.asDiagonal();
  const MatrixXcd p = spectrum.a.topRows(excitation.F.cols());
  Recovery(model, excitation, damping, outputs, tables).add<MatrixXcd>(spectrum.hz, make_apply(W, z), p, result);
}

void recover(const fe::Model& model, const ResponseModel& response, const Excitation& excitation,
             const DampingChoice& damping, const std::vector<OutputChoice>& outputs, const History& history,
             records::ResponseSubcase& result) {
  const MatrixXd W = join_shapes(response);
  const std::array<MatrixXd, 3> z{stack<MatrixXd>(history.q, history.d), stack<MatrixXd>(history.q_dot, history.d_dot),
                                  stack<MatrixXd>(history.q_ddot, history.d_ddot)};
  const MatrixXd p = history.a.topRows(excitation.F.cols());
  Recovery(model, excitation, damping, outputs).add<MatrixXd>(history.time, make_apply(W, z), p, result);
}

void recover(const fe::Model& model, const Excitation& excitation, const DampingChoice& damping,
             const std::vector<OutputChoice>& outputs, const MotionBlock<MatrixXcd>& motion,
             const FrequencyTables* tables, records::ResponseSubcase& result) {
  add_motion(Recovery(model, excitation, damping, outputs, tables), motion, result);
}

void recover(const fe::Model& model, const Excitation& excitation, const DampingChoice& damping,
             const std::vector<OutputChoice>& outputs, const MotionBlock<MatrixXd>& motion,
             records::ResponseSubcase& result) {
  add_motion(Recovery(model, excitation, damping, outputs), motion, result);
}

}  // namespace bough::modal::response
