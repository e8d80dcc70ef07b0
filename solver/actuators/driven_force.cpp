#include "solver/actuators/driven_force.hpp"

namespace bough::solver {
namespace {

class DrivenForce final : public Block {
 public:
  explicit DrivenForce(const AppliedForce& force) : force_(&force) { sizes.inputs = 1; }
  bool is_actuator() const override { return true; }
  void calc_outputs(const BlockInput& in, double* y) const override { y[0] = in.u[0]; }
  void add_load(const BlockInput& in, const double* y, TreeData& data) const override {
    add_applied_load(*force_, in.motion->tree, y[0], data);
  }

 private:
  const AppliedForce* force_;
};

}  // namespace

std::unique_ptr<Block> make_driven_force(const AppliedForce& force, const SourceLocation& at) {
  auto made = std::make_unique<DrivenForce>(force);
  made->set_name(BlockKind::Force, force.name);
  made->label = "force '" + force.name + "'";
  made->description = "what the force is multiplied by";
  made->dims = "by the signal";
  made->at = at;
  return made;
}

}  // namespace bough::solver
