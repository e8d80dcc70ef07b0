#include "modal/complex/physical_input.hpp"

#include <algorithm>
#include <map>

#include "modal/response/excitation.hpp"

namespace bough::modal::complex_modes {
namespace {

using records::CardLocation;

class Collector {
 public:
  Collector(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
            Diagnostics& diagnostics)
      : model_(model), deck_(deck), subcase_(subcase), diagnostics_(diagnostics) {}

  PhysicalInput collect() {
    const auto& d = subcase_.dynamics;
    add_matrices("K2PP", d.k2pp, K_);
    add_matrices("B2PP", d.b2pp, B_);
    add_matrices("M2PP", d.m2pp, M_);
    if (d.tfl != 0) add_transfer_functions(d.tfl);
    return make();
  }

 private:
  using Terms = std::vector<Eigen::Triplet<Complex>>;

  /// Row among the dofs of direct input; -1 after reporting.
  int find_row(int g, int c, const std::string& card, const CardLocation& at) {
    const bool is_extra = deck_.dynamics.extra_points.count(g) > 0;
    if (is_extra && c > 1) {
      diagnostics_.error("fe.bad-component", deck_.locate(at),
                         card + " names extra point " + std::to_string(g) + " with component " + std::to_string(c) +
                             ", expected 0 or 1",
                         "correct the component");
      return -1;
    }
    const int gdof = is_extra ? -1 : response::find_dof(model_, deck_, g, c, card, at, diagnostics_);
    if (!is_extra && gdof < 0) return -1;
    const auto [found, is_new] = rows_.try_emplace({is_extra ? 1 : 0, is_extra ? g : gdof}, num_rows_);
    if (!is_new) return found->second;
    if (is_extra) {
      names_.push_back("extra point " + std::to_string(g));
    } else {
      const auto& node = model_.node(model_.find_node(g));
      names_.push_back("grid " + std::to_string(g) + " component " + std::to_string(c));
      if (node.num_dofs == 1) {
        N_g_.emplace_back(num_rows_, gdof, 1.0);
      } else {
        const int slot = c - 1, first = node.first_gdof + 3 * (slot / 3);
        for (int k = 0; k < 3; ++k)
          if (const double r = node.R_basic_cd(k, slot % 3); r != 0) N_g_.emplace_back(num_rows_, first + k, r);
      }
    }
    return num_rows_++;
  }

  void add(Terms& terms, int row, int column, Complex value) {
    if (value != 0.0) terms.emplace_back(row, column, value);
  }

  void add_matrices(const char* command, const std::vector<std::pair<double, std::string>>& names, Terms& terms) {
    for (const auto& [scale, name] : names) {
      const auto& all = deck_.direct_matrices;
      const auto matrix = std::find_if(all.begin(), all.end(), [&, &n = name](const auto& m) { return m.name == n; });
      if (matrix == all.end()) {
        diagnostics_.error("fe.missing-direct", deck_.locate(subcase_.find_command(command)),
                           std::string(command) + " selects " + name + ", but the deck has no DMIG of that name",
                           "correct the name or add the DMIG");
        continue;
      }
      if (matrix->form != 1 && matrix->form != 6) {
        diagnostics_.error("modal.direct-shape", deck_.locate(matrix->at),
                           "DMIG " + name + " of " + command + " has IFO " + std::to_string(matrix->form) +
                               ", expected a square matrix",
                           "write IFO 1 (every term) or 6 (symmetric, each term once)");
        continue;
      }
      for (const auto& e : matrix->entries) {
        const int i = find_row(e.gi, e.ci, "DMIG " + name, matrix->at);
        const int j = find_row(e.gj, e.cj, "DMIG " + name, matrix->at);
        if (i < 0 || j < 0) continue;
        const Complex value = scale * Complex(e.value, e.imaginary);
        add(terms, i, j, value);
        if (matrix->form == 6 && i != j) add(terms, j, i, value);
      }
    }
  }

  void add_transfer_functions(int set) {
    bool is_found = false;
    for (const auto& f : deck_.dynamics.transfer_functions) {
      if (f.sid != set) continue;
      is_found = true;
      const std::string card = "TF " + std::to_string(set);
      const int row = find_row(f.of.g, f.of.c, card, f.at);
      auto terms = f.terms;
      terms.push_back(f.of);
      for (const auto& t : terms) {
        const int column = find_row(t.g, t.c, card, f.at);
        if (row < 0 || column < 0) continue;
        add(K_, row, column, t.a0);
        add(B_, row, column, t.a1);
        add(M_, row, column, t.a2);
      }
    }
    if (!is_found)
      diagnostics_.error("modal.missing-transfer", deck_.locate(subcase_.find_command("TFL")),
                         "TFL = " + std::to_string(set) + " names no TF card of the deck",
                         "add the cards or correct the id");
  }

  PhysicalInput make() {
    PhysicalInput input;
    Terms* const all[] = {&K_, &B_, &M_};
    ComplexSparse* const matrices[] = {&input.K, &input.B, &input.M};
    for (int i = 0; i < 3; ++i) {
      matrices[i]->resize(num_rows_, num_rows_);
      matrices[i]->setFromTriplets(all[i]->begin(), all[i]->end());
    }
    std::vector<Eigen::Triplet<double>> extra;
    for (const auto& [key, row] : rows_) {
      if (key.first == 0) continue;
      extra.emplace_back(row, static_cast<int>(input.extra_points.size()), 1.0);
      input.extra_points.push_back(key.second);
    }
    input.N_g.resize(num_rows_, model_.num_gdofs());
    input.N_g.setFromTriplets(N_g_.begin(), N_g_.end());
    input.N_e.resize(num_rows_, static_cast<Index>(input.extra_points.size()));
    input.N_e.setFromTriplets(extra.begin(), extra.end());
    input.names = names_;
    report_unused(input);
    return input;
  }

  void report_unused(const PhysicalInput& input) {
    std::string unused;
    int count = 0;
    for (const int id : deck_.dynamics.extra_points) {
      if (std::binary_search(input.extra_points.begin(), input.extra_points.end(), id)) continue;
      if (++count <= 10) unused += (unused.empty() ? "" : ", ") + std::to_string(id);
    }
    if (count == 0) return;
    diagnostics_.warning("modal.extra-point-unused", deck_.locate({}),
                         "no matrix and no transfer function of the subcase has a term at EPOINT " + unused +
                             (count > 10 ? " and " + std::to_string(count - 10) + " more" : "") +
                             ": left out of the complex modes",
                         "select the DMIG (K2PP, B2PP, M2PP) or the TF (TFL) with terms there");
  }

  const fe::Model& model_;
  const records::DynamicDeck& deck_;
  const records::DynamicSubcase& subcase_;
  Diagnostics& diagnostics_;
  std::map<std::pair<int, int>, int> rows_;  ///< (0, g-dof in CD axes) or (1, extra point)
  std::vector<std::string> names_;
  int num_rows_ = 0;
  std::vector<Eigen::Triplet<double>> N_g_;
  Terms K_, B_, M_;
};

}  // namespace

Eigen::SparseMatrix<double> PhysicalInput::calc_transform(const Eigen::SparseMatrix<double>& T) const {
  const Eigen::SparseMatrix<double> moved = N_g * T;
  std::vector<Eigen::Triplet<double>> terms;
  for (Index c = 0; c < moved.outerSize(); ++c)
    for (Eigen::SparseMatrix<double>::InnerIterator it(moved, c); it; ++it)
      terms.emplace_back(static_cast<int>(it.row()), static_cast<int>(c), it.value());
  for (Index c = 0; c < N_e.outerSize(); ++c)
    for (Eigen::SparseMatrix<double>::InnerIterator it(N_e, c); it; ++it)
      terms.emplace_back(static_cast<int>(it.row()), static_cast<int>(T.cols() + c), it.value());
  Eigen::SparseMatrix<double> N(N_g.rows(), T.cols() + N_e.cols());
  N.setFromTriplets(terms.begin(), terms.end());
  return N;
}

PhysicalInput collect_physical_input(const fe::Model& model, const records::DynamicDeck& deck,
                                     const records::DynamicSubcase& subcase, Diagnostics& diagnostics) {
  return Collector(model, deck, subcase, diagnostics).collect();
}

}  // namespace bough::modal::complex_modes
