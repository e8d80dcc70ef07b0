#pragma once
/// \file Makers of the controllers' blocks, one a family; for controller.cpp.
#include "solver/control/controller.hpp"
#include "solver/text/settings.hpp"

namespace bough::solver {

std::unique_ptr<Block> make_transfer_function(SettingsReader& keys, const ControllerWiring& wiring, bool is_sampled);
std::unique_ptr<Block> make_state_space(SettingsReader& keys, const ControllerWiring& wiring, bool is_sampled);
std::unique_ptr<Block> make_gain(SettingsReader& keys, const ControllerWiring& wiring);
std::unique_ptr<Block> make_sum(SettingsReader& keys, const ControllerWiring& wiring);
/// The bilinear transform where it is sampled.
std::unique_ptr<Block> make_notch(SettingsReader& keys, const ControllerWiring& wiring, double sample_time);
std::unique_ptr<Block> make_lead_lag(SettingsReader& keys, const ControllerWiring& wiring, double sample_time);

std::unique_ptr<Block> make_pid(SettingsReader& keys, const ControllerWiring& wiring, double sample_time);

std::unique_ptr<Block> make_product(SettingsReader& keys, const ControllerWiring& wiring);
std::unique_ptr<Block> make_limit(SettingsReader& keys, const ControllerWiring& wiring);
std::unique_ptr<Block> make_table(SettingsReader& keys, const ControllerWiring& wiring);

std::unique_ptr<Block> make_relay(SettingsReader& keys, const ControllerWiring& wiring);
std::unique_ptr<Block> make_pwpf(SettingsReader& keys, const ControllerWiring& wiring);
std::unique_ptr<Block> make_switch(SettingsReader& keys, const ControllerWiring& wiring);

std::unique_ptr<Block> make_expression(SettingsReader& keys, const ControllerWiring& wiring);
std::unique_ptr<Block> make_library(SettingsReader& keys, const ControllerWiring& wiring);
/// Functions that a host lends for the FMU; "control.no-fmu" where none does.
std::unique_ptr<Block> make_fmu(SettingsReader& keys, const ControllerWiring& wiring);

}  // namespace bough::solver
