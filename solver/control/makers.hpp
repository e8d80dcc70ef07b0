#pragma once
/// \file Makers of the controllers' blocks, one a family; for controller.cpp.
#include "solver/control/controller.hpp"
#include "solver/text/settings.hpp"

namespace bough::solver {

/// Rational function of s, of z if it is sampled, for each input component; null after reporting.
std::unique_ptr<Block> make_transfer_function(SettingsReader& keys, const ControllerWiring& wiring, bool is_sampled);
/// Matrices A, B, C, D and the initial state; absent matrices are zero. Null after reporting.
std::unique_ptr<Block> make_state_space(SettingsReader& keys, const ControllerWiring& wiring, bool is_sampled);
/// y = D u: a full matrix, a diagonal or one number; null after reporting.
std::unique_ptr<Block> make_gain(SettingsReader& keys, const ControllerWiring& wiring);
/// Weighted sum of inputs of equal size; null after reporting.
std::unique_ptr<Block> make_sum(SettingsReader& keys, const ControllerWiring& wiring);
/// The bilinear transform where it is sampled.
std::unique_ptr<Block> make_notch(SettingsReader& keys, const ControllerWiring& wiring, double sample_time);
/// gain (1 + lead s) / (1 + lag s) for each input component, by the bilinear transform where it is sampled.
std::unique_ptr<Block> make_lead_lag(SettingsReader& keys, const ControllerWiring& wiring, double sample_time);

/// PID with derivative filter, limits and back-calculation against windup; in discrete form for sample_time > 0.
std::unique_ptr<Block> make_pid(SettingsReader& keys, const ControllerWiring& wiring, double sample_time);

/// Product of inputs of equal size, component by component, times a gain.
std::unique_ptr<Block> make_product(SettingsReader& keys, const ControllerWiring& wiring);
/// Saturation with a dead band, for each component.
std::unique_ptr<Block> make_limit(SettingsReader& keys, const ControllerWiring& wiring);
/// Linear interpolation in a table of one input, for each component, or of two inputs; end values outside.
std::unique_ptr<Block> make_table(SettingsReader& keys, const ControllerWiring& wiring);

/// Relay with a dead band and hysteresis, for each component; its output depends on its memory alone.
std::unique_ptr<Block> make_relay(SettingsReader& keys, const ControllerWiring& wiring);
/// Pulse-width pulse-frequency modulator, for each component.
std::unique_ptr<Block> make_pwpf(SettingsReader& keys, const ControllerWiring& wiring);
/// Switch between two inputs by a third one with hysteresis, or by events.
std::unique_ptr<Block> make_switch(SettingsReader& keys, const ControllerWiring& wiring);

/// Formulas of the inputs u1, u2, ... and the time t; null after reporting.
std::unique_ptr<Block> make_expression(SettingsReader& keys, const ControllerWiring& wiring);
/// Controller of a shared library of the user (bough_controller.h); null after reporting.
std::unique_ptr<Block> make_library(SettingsReader& keys, const ControllerWiring& wiring);
/// Uses the functions of the host for FMUs; "control.no-fmu" if there are none.
std::unique_ptr<Block> make_fmu(SettingsReader& keys, const ControllerWiring& wiring);

}  // namespace bough::solver
