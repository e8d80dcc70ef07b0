#include "solver/signals/block.hpp"

namespace bough::solver {

const char* get_folder(BlockKind kind) {
  static constexpr const char* folders[] = {"/signals/",   "/inputs/", "/sensors/",   "/controllers/",
                                            "/actuators/", "/forces/", "/stiffening/"};
  return folders[static_cast<std::size_t>(kind)];
}

void Block::set_name(BlockKind block_kind, const std::string& block_name) {
  kind = block_kind;
  name = block_name;
  path = get_folder(kind) + name;
}

void Block::start(double*, double*) const {}
bool Block::settle(const BlockInput&, double*) const { return false; }
void Block::calc_ideal(const BlockInput& in, double* y) const { calc_outputs(in, y); }
void Block::calc_rates(const BlockInput&, double*) const {}
void Block::update(const BlockInput&, double*) const {}
void Block::calc_event_functions(const BlockInput&, double*) const {}
void Block::switch_over(const BlockInput&, int, double*) const {}
std::string Block::describe_switch(const Motion&, int) const { return {}; }
void Block::choose(int, double*) const {}
void Block::mark_motion(const Tree&, std::vector<bool>& q, std::vector<bool>& u) const {
  q.assign(q.size(), true);
  u.assign(u.size(), true);
}
void Block::add_load(const BlockInput&, const double*, TreeData&) const {}
double Block::calc_power(const BlockInput&, const double*) const { return 0; }
double Block::calc_energy(const BlockInput&) const { return 0; }
Vector3d Block::calc_momentum(const BlockInput&) const { return Vector3d::Zero(); }
void Block::add_consumption(const BlockInput&, Eigen::Ref<Eigen::VectorXd>) const {}

}  // namespace bough::solver
