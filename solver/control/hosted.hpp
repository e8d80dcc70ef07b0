#pragma once
/// \file Controllers of type "library" that live in this process, not in a shared library: a host program (the Python
/// module) lends the functions of bough_controller.h under the file name that the system file or the host gives.
#include <functional>
#include <optional>
#include <string>

#include "solver/control/bough_controller.h"
#include "solver/text/settings.hpp"

namespace bough::solver {

/// The functions of bough_controller.h; those that may be left out there may be empty.
struct ControllerFunctions {
  std::string language;          ///< of the host, for messages: "Python"; empty: a shared library
  bool is_opaque = false;        ///< the memory is no set of numbers: no linear model can be made ("linear.fmu")
  bool is_forward_only = false;  ///< a run cannot go on from a memory of another run ("control.cannot-resume")
  std::function<int()> version;
  std::function<int(bough_controller*)> open;
  std::function<int(void*, double, const double*, const double*, const double*, double*)> outputs;
  std::function<int(void*, double*, double*)> start;
  std::function<int(void*, double, const double*, const double*, const double*, double*)> derivatives, update;
  std::function<void(void*)> close;
};

/// Lends `functions` to every controller built from now on whose `file` is that name, until the object ends. Systems
/// built meanwhile keep them.
class HostedController {
 public:
  HostedController(std::string file, ControllerFunctions functions);
  ~HostedController();
  HostedController(const HostedController&) = delete;
  HostedController& operator=(const HostedController&) = delete;

 private:
  std::string file_;
};

/// Functions that a host lends under that file name, if one does.
std::optional<ControllerFunctions> find_hosted_controller(const std::string& file);

}  // namespace bough::solver
