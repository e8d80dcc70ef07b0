// Actuator on a modal coordinate: a generalized force on one mode of a flexible body, without resultant on the body.
#include "solver/actuators/makers.hpp"

namespace bough::solver {
namespace {

class ModalActuator final : public Actuator {
 public:
  int row = -1;  ///< of TreeData::applied

  void calc_outputs(const BlockInput& in, double* y) const override { y[0] = calc_command(in); }
  void add_load(const BlockInput&, const double* y, TreeData& data) const override { data.applied[row] += y[0]; }
};

}  // namespace

std::unique_ptr<Actuator> make_modal_actuator(const records::ActuatorRecord&, SettingsReader& keys,
                                              const ActuatorPlace& place) {
  auto made = std::make_unique<ModalActuator>();
  made->row = place.row;
  made->read_shaping(keys);
  made->description = "generalized force on the mode";
  made->dims = "by normalisation";
  return made;
}

}  // namespace bough::solver
