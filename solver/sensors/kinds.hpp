#pragma once
/// \file The kinds of sensors: one row each.
#include "formats/records/system_spec.hpp"

namespace bough::solver {

enum class SensorOf {
  Point,       ///< body, node, frame, relative_to
  Elastic,     ///< body, node, frame
  Attitude,    ///< body, node, mount, relative_to
  Instrument,  ///< body, node, mount
  Coordinate,  ///< hinge, coordinate
  HingeLoad,   ///< hinge
  Modes,       ///< body, coordinate
  Energy,      ///< body
  Gap,         ///< body, node, to_body, to_node
  Element      ///< body, element, component
};

struct SensorKind {
  records::SensorType type;
  const char* name;
  const char* dims;
  SensorOf of;
  int size;  ///< 0: as many as the hinge or the body has
  bool reads_acceleration;
};

const SensorKind& get_kind(records::SensorType type);

}  // namespace bough::solver
