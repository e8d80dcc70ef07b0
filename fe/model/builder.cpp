#include "fe/model/builder.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "base/number_text.hpp"
#include "fe/cards/maker.hpp"
#include "fe/cards/material_temperatures.hpp"
#include "fe/cards/nonstructural.hpp"
#include "fe/model/coordinates.hpp"
#include "fe/model/direct_matrices.hpp"
#include "fe/model/load_selection.hpp"
#include "fe/model/rigid.hpp"
#include "fe/model/sets.hpp"
#include "fe/model/superelements.hpp"
#include "fe/model/unmodelled.hpp"

namespace bough::fe {
namespace {

constexpr unsigned kTranslations = 7u;  ///< mask of components 1, 2, 3

/// T = R C: rotates the rows of C from the displacement axes of each node to basic.
SparseRows rotate_rows(const std::vector<Node>& nodes, const SparseRows& C) {
  const bool is_plain = std::all_of(nodes.begin(), nodes.end(),
                                    [](const Node& n) { return n.num_dofs != 6 || n.R_basic_cd.isIdentity(0); });
  if (is_plain) return C;
  SparseRows R(C.rows(), C.rows());
  R.reserve(Eigen::VectorXi::Constant(C.rows(), 3));
  for (const Node& node : nodes) {
    if (node.num_dofs != 6) {
      for (int i = 0; i < node.num_dofs; ++i) R.insert(node.first_gdof + i, node.first_gdof + i) = 1;
      continue;
    }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 3; ++j)
        if (const double v = node.R_basic_cd(i % 3, j); v != 0)
          R.insert(node.first_gdof + i, node.first_gdof + 3 * (i / 3) + j) = v;
  }
  R.makeCompressed();
  SparseRows T = (R * C).pruned();
  T.makeCompressed();
  return T;
}

}  // namespace

Model ModelBuilder::build(const ElementFactory& factory) {
  model_.subcase_ = select_subcase(deck_, options_.subcase, diagnostics_);
  set_params();
  add_nodes();
  make_elements(factory);
  set_prestress();
  auto equations = collect_constraints();
  diagnostics_.throw_if_errors();
  model_.links_ = Links(std::move(links_), std::move(equations));
  apply_autospc(set_transform());
  add_drawn_lines();
  return std::move(model_);
}

std::vector<ConstraintEquation> ModelBuilder::collect_constraints() {
  is_fixed_.assign(model_.num_gdofs_, 0);
  collect_fixed();
  hold_spcd();
  collect_equations();
  check_dependent_not_fixed();
  auto equations = equations_;
  equations_ = resolve_chains(
      model_.num_gdofs_, std::move(equations_), [this](int l) { return model_.name_dof(l); }, diagnostics_);
  if (!deck_.aset.empty() || !deck_.omit.empty()) {  // the a-set says which card constrains a DOF that it names
    for (const auto& equation : equations_)
      model_.constrained_dofs_.push_back({equation.dependent, equation.card, equation.at});
    for (const auto& [ldof, at] : fixed_by_) model_.constrained_dofs_.push_back({ldof, {}, at});
  }
  return equations;
}

void ModelBuilder::make_elements(const ElementFactory& factory) {
  const auto add = [this](ElementList list) {
    for (const auto& element : list.elements) {  // lists that are not the catalogue's say nothing of them
      list.cards.insert(element->card());
      list.has_damping = list.has_damping || element->damping() != nullptr;
    }
    model_.cards_.merge(list.cards);
    model_.has_damping_ = model_.has_damping_ || list.has_damping;
    for (auto& element : list.elements) model_.elements_.push_back(std::move(element));
  };
  const auto at_temperature = evaluate_materials(deck_, model_.subcase_, model_, diagnostics_);
  if (at_temperature.deck) {
    Diagnostics of_copies;
    add(factory(*at_temperature.deck, model_, of_copies));
    for (auto item : of_copies.items()) {
      item.what = at_temperature.name_originals(item.what);
      diagnostics_.add(std::move(item));
    }
  } else {
    add(factory(deck_, model_, diagnostics_));
  }
  report_unmodelled(deck_, model_.cards_, diagnostics_);
  ElementList direct = make_direct(deck_, model_.subcase_, model_, diagnostics_);
  if (options_.adjust_direct && !direct.elements.empty())
    options_.adjust_direct(deck_, model_.elements_, direct, diagnostics_);
  add(std::move(direct));
  BOUGH_DEMAND(deck_.super.sebulk.empty() || deck_.super.is_joined);
  add(make_superelements(deck_, model_, options_.origin.value_or(Vector3d::Zero()), model_.wtmass_, diagnostics_));
  add(make_nonstructural(deck_, model_.subcase_.nsm, model_.elements_, model_, diagnostics_));
}

void ModelBuilder::set_params() {
  model_.wtmass_ = get_real_param(deck_, "WTMASS", 1, diagnostics_);
  const auto* coupmass = deck_.find_param("COUPMASS");
  const bool is_word = coupmass && (coupmass->value == "YES" || coupmass->value == "NO");
  const bool is_coupled = is_word ? coupmass->value == "YES" : get_real_param(deck_, "COUPMASS", -1, diagnostics_) > 0;
  model_.mass_kind_ = options_.mass_kind.value_or(is_coupled ? MassKind::Consistent : MassKind::Lumped);
}

void ModelBuilder::add_nodes() {
  if (const auto refused = deck_.refused.find("GRID"); refused != deck_.refused.end())
    model_.refused_grids_ = refused->second;
  const Vector3d origin = options_.origin.value_or(Vector3d::Zero());
  model_.systems_ = std::make_shared<const CoordinateSystems>(deck_, origin, diagnostics_);
  if (deck_.grids.empty() && deck_.scalar_points.empty() && model_.refused_grids_.empty())
    diagnostics_.error("fe.no-grids", deck_.locate({}), "the deck has no GRID", "give the bulk data of a model");
  std::vector<int> order(deck_.grids.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [this](int a, int b) { return deck_.grids[a].id < deck_.grids[b].id; });
  for (int i : order) {
    const records::Grid& grid = deck_.grids[i];
    if (!model_.node_index_.emplace(grid.id, static_cast<int>(model_.nodes_.size())).second) continue;
    Node node;
    node.id = grid.id;
    node.x = model_.systems_->get_grid_position(i);
    node.R_basic_cd = model_.systems_->calc_axes(grid.cd, node.x, deck_.locate(grid.at), diagnostics_);
    node.first_gdof = model_.num_gdofs_;
    model_.num_gdofs_ += node.num_dofs;
    model_.nodes_.push_back(node);
  }
  add_scalar_points();
}

void ModelBuilder::add_scalar_points() {
  const std::set<int> points(deck_.scalar_points.begin(), deck_.scalar_points.end());
  for (int id : points) {
    if (!model_.node_index_.emplace(id, static_cast<int>(model_.nodes_.size())).second) {
      diagnostics_.error("fe.grid-and-scalar", deck_.locate({}),
                         "point " + std::to_string(id) +
                             " is a GRID and a scalar point (SPOINT, or named by CELAS3, "
                             "CELAS4, CMASS3 or CMASS4)",
                         "give one of them another id");
      continue;
    }
    Node node;
    node.id = id;
    node.num_dofs = 1;
    node.first_gdof = model_.num_gdofs_++;
    model_.nodes_.push_back(node);
  }
}

void ModelBuilder::fix(const records::Spc& spc) {
  const SourceLocation at = deck_.locate(spc.at);
  const int index = model_.find_node(spc.g);
  if (index < 0) {
    if (!spc.skip_if_missing) model_.find_ldof(spc.g, 0, "SPC set " + std::to_string(spc.sid), at, diagnostics_);
    return;
  }
  const Node& node = model_.nodes_[index];
  if (node.num_dofs == 6 && spc.c == 0) {
    diagnostics_.error("fe.bad-component", at,
                       "SPC set " + std::to_string(spc.sid) + " names no component of grid " + std::to_string(spc.g) +
                           ", expected digits 1 to 6",
                       "write the components that it fixes");
    return;
  }
  for (int c = 0; c < node.num_dofs; ++c)
    if (node.num_dofs == 1 || (spc.c >> c & 1u)) {
      is_fixed_[node.first_gdof + c] = 1;
      fixed_by_.emplace_back(node.first_gdof + c, at);
    }
  for (int c = 0; c < node.num_dofs && spc.d != 0; ++c)
    if (node.num_dofs == 1 || (spc.c >> c & 1u)) {
      const auto [known, is_new] = model_.spc_displacements_.emplace(node.first_gdof + c, spc.d);
      if (is_new || known->second == spc.d) continue;
      diagnostics_.warning("fe.enforced-twice", at,
                           "SPC set " + std::to_string(spc.sid) + " moves grid " + std::to_string(spc.g) +
                               " component " + std::to_string(node.num_dofs == 1 ? 0 : c + 1) + " by " +
                               show_number(spc.d) + ", and another card by " + show_number(known->second) +
                               "; the last card is taken",
                           "remove one of the two cards");
      known->second = spc.d;
    }
  if (spc.d != 0 && !options_.uses_enforced)
    diagnostics_.warning("fe.enforced-ignored", at,
                         "SPC set " + std::to_string(spc.sid) + " enforces a displacement at grid " +
                             std::to_string(spc.g) + "; it is taken as zero",
                         "model the enforced displacement as a load");
}

template <class Card>
bool ModelBuilder::is_set_of_section(int sid, std::vector<Card> records::Deck::*cards,
                                     std::vector<records::SetUnion> records::Deck::*unions) const {
  const auto has = [&](const records::Deck& deck) {
    const auto is_of = [sid](const auto& card) { return card.sid == sid; };
    return std::any_of((deck.*cards).begin(), (deck.*cards).end(), is_of) ||
           std::any_of((deck.*unions).begin(), (deck.*unions).end(), is_of);
  };
  return !has(deck_) && std::any_of(deck_.super.sections.begin(), deck_.super.sections.end(),
                                    [&](const auto& section) { return has(*section.deck); });
}

void ModelBuilder::collect_fixed() {
  for (const auto& grid : deck_.grids) {
    const int index = model_.find_node(grid.id);
    // A free-free body keeps only a PS of rotations alone: decks use it against rotations without stiffness.
    if (index < 0 || (options_.ignore_spc && (grid.ps & kTranslations))) continue;
    for (int c = 0; c < 6; ++c)
      if (grid.ps >> c & 1u) {
        is_fixed_[model_.nodes_[index].first_gdof + c] = 1;
        fixed_by_.emplace_back(model_.nodes_[index].first_gdof + c, deck_.locate(grid.at));
      }
  }
  if (options_.ignore_spc) return;
  std::set<int> plain;
  for (const auto& spc : deck_.spc) plain.insert(spc.sid);
  int sid = model_.subcase_.spc;
  const bool has_case_control = !deck_.sol.empty() || deck_.subcases.size() > 1 || model_.subcase_.id > 0 ||
                                model_.subcase_.mpc || model_.subcase_.load || model_.subcase_.method;
  if (sid == 0 && !has_case_control && plain.size() == 1) {
    sid = *plain.begin();
    diagnostics_.note("fe.only-spc-set", deck_.locate({}),
                      "the deck has no case control; its only SPC set " + std::to_string(sid) + " is used",
                      "select the set with SPC = in case control");
  }
  if (sid == 0 || is_set_of_section(sid, &records::Deck::spc, &records::Deck::spcadd)) return;
  const auto sets = expand_set(sid, deck_.spcadd, {plain.begin(), plain.end()}, "SPC", deck_, diagnostics_);
  for (const auto& spc : deck_.spc)
    if (std::binary_search(sets.begin(), sets.end(), spc.sid)) fix(spc);
}

void ModelBuilder::hold_spcd() {
  if (!options_.uses_enforced || options_.ignore_spc) return;
  const records::Spcd* first = nullptr;
  for (const auto& [dof, card] : list_spcd_dofs(model_, deck_, model_.subcase_.load)) {
    if (is_fixed_[dof]) continue;
    if (!first) first = card;
    is_fixed_[dof] = 1;
    fixed_by_.emplace_back(dof, deck_.locate(card->at));
    model_.fixed_by_spcd_.push_back(dof);
  }
  if (!first) return;
  const auto num = model_.fixed_by_spcd_.size();
  diagnostics_.warning("fe.spcd-not-fixed", deck_.locate(first->at),
                       "SPCD moves " + model_.name_dof(model_.fixed_by_spcd_.front()) +
                           (num > 1 ? " (and " + std::to_string(num - 1) + " dofs more)" : "") +
                           ", which no SPC of the subcase fixes; it is constrained as if one did",
                       "fix it with the SPC set of the subcase");
}

void ModelBuilder::add_mpc(const records::Mpc& mpc) {
  const SourceLocation at = deck_.locate(mpc.at);
  ConstraintEquation equation;
  equation.card = "MPC set " + std::to_string(mpc.sid);
  equation.at = at;
  if (mpc.terms.empty() || mpc.terms.front().a == 0) {
    diagnostics_.error("fe.zero-mpc", at,
                       equation.card + " has no coefficient on its first term, expected one that is not zero",
                       "put a term with a coefficient first");
    return;
  }
  bool is_valid = true;
  for (const auto& term : mpc.terms) {
    const int ldof = model_.find_ldof(term.g, term.c, equation.card, at, diagnostics_);
    is_valid = is_valid && ldof >= 0;
    if (&term == &mpc.terms.front())
      equation.dependent = ldof;
    else if (term.a != 0)
      equation.terms.emplace_back(ldof, -term.a / mpc.terms.front().a);
  }
  if (is_valid) equations_.push_back(std::move(equation));
}

void ModelBuilder::collect_equations() {
  for (const auto& card : deck_.rbe1) add_rbe1(card, model_, deck_.locate(card.at), diagnostics_, equations_, links_);
  for (const auto& card : deck_.rbe2) add_rbe2(card, model_, deck_.locate(card.at), diagnostics_, equations_, links_);
  for (const auto& card : deck_.rbe3) add_rbe3(card, model_, deck_.locate(card.at), diagnostics_, equations_, links_);
  for (const auto& card : deck_.rrod) add_rrod(card, model_, deck_.locate(card.at), diagnostics_, equations_, links_);
  for (const auto& card : deck_.rbar) add_rbar(card, model_, deck_.locate(card.at), diagnostics_, equations_, links_);
  for (const auto& card : deck_.special.rspline)
    add_rspline(card, model_, deck_.locate(card.at), diagnostics_, equations_);
  if (model_.subcase_.mpc == 0) return;
  std::set<int> plain, known;
  for (const auto& mpc : deck_.mpc) plain.insert(mpc.sid);
  for (const auto& united : deck_.mpcadd) known.insert(united.sid);
  known.insert(plain.begin(), plain.end());
  if (is_set_of_section(model_.subcase_.mpc, &records::Deck::mpc, &records::Deck::mpcadd)) return;
  // Other codes run such a deck: the selection is often left over in the case control when the cards are gone.
  if (!known.contains(model_.subcase_.mpc))
    return diagnostics_.warning(
        "fe.empty-mpc-set", deck_.locate(model_.subcase_.find_command("MPC")),
        "MPC set " + std::to_string(model_.subcase_.mpc) + " is selected but has no cards; nothing is coupled by it",
        "correct the set id or remove the selection");
  const auto sets =
      expand_set(model_.subcase_.mpc, deck_.mpcadd, {plain.begin(), plain.end()}, "MPC", deck_, diagnostics_);
  for (const auto& mpc : deck_.mpc)
    if (std::binary_search(sets.begin(), sets.end(), mpc.sid)) add_mpc(mpc);
}

void ModelBuilder::check_dependent_not_fixed() {
  std::unordered_map<int, const ConstraintEquation*> dependent;
  for (const auto& equation : equations_) dependent.emplace(equation.dependent, &equation);
  std::set<int> reported;
  for (const auto& [ldof, at] : fixed_by_) {
    const auto found = dependent.find(ldof);
    if (found == dependent.end() || !reported.insert(ldof).second) continue;
    diagnostics_.error("fe.dependent-fixed", at,
                       model_.name_dof(ldof) + " is fixed here and made dependent by " + found->second->card,
                       "fix an independent dof instead, or free this one");
  }
}

Elimination ModelBuilder::set_transform() {
  Elimination elimination = eliminate(model_.num_gdofs_, equations_, is_fixed_);
  model_.T_ = rotate_rows(model_.nodes_, elimination.C);
  const FixedPart fixed = collect_fixed_part(model_.num_gdofs_, equations_, is_fixed_);
  model_.T_fixed_ = rotate_rows(model_.nodes_, fixed.C);
  model_.fixed_dofs_ = fixed.ldofs;
  model_.node_fdof_.assign(model_.nodes_.size(), {-1, -1, -1, -1, -1, -1});
  model_.fdof_node_.clear();
  model_.fdof_component_.clear();
  int k = 0;
  for (size_t f = 0; f < elimination.fdof_ldof.size(); ++f) {
    const int ldof = elimination.fdof_ldof[f];
    while (ldof >= model_.nodes_[k].first_gdof + model_.nodes_[k].num_dofs) ++k;
    const int slot = ldof - model_.nodes_[k].first_gdof;
    model_.node_fdof_[k][slot] = static_cast<int>(f);
    model_.fdof_node_.push_back(k);
    model_.fdof_component_.push_back(model_.nodes_[k].num_dofs == 1 ? 0 : slot + 1);
  }
  return elimination;
}

}  // namespace bough::fe
