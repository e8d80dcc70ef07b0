#include "fe/matrices/mass_directions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "fe/matrices/grid_point_weight.hpp"

namespace bough::fe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

records::CardLocation find_card(const records::Deck& deck, const std::string& card, int id) {
  const auto find = [&](const auto& list) {
    const auto found = std::find_if(list.begin(), list.end(), [id](const auto& record) { return record.id == id; });
    return found == list.end() ? records::CardLocation{} : found->at;
  };
  if (card.starts_with("CMASS")) return find(deck.scalar_masses);
  return card == "CONM1" ? find(deck.conm1) : records::CardLocation{};
}

/// Card and id of the elements whose mass differs by direction, in the order of the deck.
std::vector<std::pair<std::string, int>> find_wrong_masses(const Model& model) {
  const MatrixXd Phi_R = model.calc_rigid_modes();
  MatrixXd M_e;
  const auto is_wrong = [&](const Element& element) {
    M_e.setZero(element.num_dofs(), element.num_dofs());
    element.add_mass(model.mass_kind(), 1, M_e);
    const MatrixXd own = Phi_R(element.gdofs(), Eigen::all);
    return calc_mass_difference(Matrix6d(own.transpose() * M_e * own)) > kMassDifference;
  };
  std::vector<std::pair<std::string, int>> wrong;
  for (const auto& element : model.elements())
    if (is_wrong(*element)) wrong.emplace_back(element->card(), element->id());
  return wrong;
}

}  // namespace

double calc_mass_difference(const Matrix6d& M) {
  const Matrix3d Mt = M.topLeftCorner<3, 3>(), S = M.bottomLeftCorner<3, 3>();
  const double mass = Mt.cwiseAbs().maxCoeff(), inertia = M.bottomRightCorner<3, 3>().cwiseAbs().maxCoeff();
  if (!(mass > 0)) return 0;
  const double translation = (Mt - Mt.trace() / 3 * Matrix3d::Identity()).cwiseAbs().maxCoeff() / mass;
  const double coupling = (S + S.transpose()).cwiseAbs().maxCoeff();
  return inertia > 0 ? std::max(translation, 0.5 * coupling / std::sqrt(mass * inertia)) : translation;
}

std::string describe_mass(const Model& model, const records::Deck& deck, const Matrix6d& rigid_mass,
                          SourceLocation& at) {
  const auto weight = calc_grid_point_weight(rigid_mass);
  const bool is_basic = weight.S.isIdentity(0);
  std::string text = "the mass is " + show_number(weight.mass[0]) + " along x, " + show_number(weight.mass[1]) +
                     " along y, " + show_number(weight.mass[2]) + " along z" +
                     (is_basic ? "" : " of its principal axes");
  const auto wrong = find_wrong_masses(model);
  std::vector<std::string> names;
  const std::size_t num = wrong.size();
  for (const auto& [card, id] : wrong) {
    if (names.size() == 5) break;
    names.push_back(card + (id > 0 ? " " + std::to_string(id) : ""));
    if (at.line == 0) at = deck.locate(find_card(deck, card, id));
  }
  for (std::size_t i = 0; i < names.size(); ++i) text += (i == 0 ? " (" : ", ") + names[i];
  if (num > names.size()) text += " and " + std::to_string(num - names.size()) + " more";
  return text + (names.empty() ? "" : ")");
}

void report_mass(const Model& model, const records::Deck& deck, const records::MassProperties& properties,
                 Diagnostics& diagnostics) {
  if (!(calc_mass_difference(properties.rigid_mass) > kMassDifference)) return;
  SourceLocation at = deck.locate({});
  const auto what = describe_mass(model, deck, properties.rigid_mass, at);
  diagnostics.warning(
      "fe.mass-by-direction", at, what + ": this is not the mass of a rigid body",
      "effective masses are shares of the mass of their own direction; a body to reduce needs one mass: "
      "give CONM2, or CMASS of one value in all three translations of one grid");
}

}  // namespace bough::fe
