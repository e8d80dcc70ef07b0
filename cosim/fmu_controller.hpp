#pragma once
/// \file Controllers of type "fmu": an FMU for Co-Simulation that advances from sample to sample.
#include "formats/records/control_spec.hpp"
#include "solver/control/hosted.hpp"

namespace bough::cosim {

/// Unpacks and loads the FMU of a [[controller]] and starts it at time 0. The functions lend it to the solver; the copy
/// that was unpacked is removed with them.
///
/// The memory of the block holds the number of steps, the time of the first, the outputs and, if the FMU can save it,
/// its state: equal arguments give equal results then, in other processes too. Outputs of a sample are those after the
/// step before it, or after the initialization: the inputs of a sample act one sample time later.
///
/// \param record  gets sample_time where it has none and the FMU recommends one, and the number and the
///                names of its outputs.
/// \throws InputError "fmu.*".
solver::ControllerFunctions load_fmu(records::ControllerRecord& record);

}  // namespace bough::cosim
