#include "formats/toml/detail/event_table.hpp"

#include <map>

namespace bough::toml_files {

records::UserEventRecord read_event(const Fields& table, Diagnostics& diagnostics) {
  records::UserEventRecord event;
  event.at = table.locate();
  event.name = table.get_string("name");
  if (table.has("time")) {
    event.time = table.get_number("time", 0);
    refuse_keys(table, {"value", "direction", "tolerance"}, "in event '" + event.name + "', which is at a time",
                diagnostics);
  }
  event.signal = table.get_string("signal");
  event.value = table.get_number("value", 0);
  event.tolerance = table.get_number("tolerance", 0);
  const std::string direction = table.get_string("direction", "both");
  event.direction = direction == "rising"    ? records::EventDirection::Rising
                    : direction == "falling" ? records::EventDirection::Falling
                                             : records::EventDirection::Both;
  static const std::map<std::string, records::EventAction> actions{
      {"log", records::EventAction::Log},       {"stop", records::EventAction::Stop},
      {"lock", records::EventAction::Lock},     {"release", records::EventAction::Release},
      {"break", records::EventAction::Break},   {"close", records::EventAction::Close},
      {"enable", records::EventAction::Enable}, {"disable", records::EventAction::Disable},
      {"switch", records::EventAction::Switch}, {"level", records::EventAction::Level}};
  const auto action = actions.find(table.get_string("action", "log"));
  if (action != actions.end()) event.action = action->second;
  using records::EventAction;
  const bool of_hinge = event.action == EventAction::Lock || event.action == EventAction::Release;
  const bool of_constraint = event.action == EventAction::Break || event.action == EventAction::Close;
  const bool of_controller = event.action == EventAction::Enable || event.action == EventAction::Disable ||
                             event.action == EventAction::Switch;
  const std::string because = "in event '" + event.name + "' whose action is " + table.get_string("action", "log");
  if (!of_hinge) refuse_keys(table, {"hinge", "coordinates"}, because, diagnostics);
  if (!of_constraint) refuse_keys(table, {"constraint"}, because, diagnostics);
  if (!of_controller) refuse_keys(table, {"controller"}, because, diagnostics);
  if (event.action != EventAction::Switch) refuse_keys(table, {"input"}, because, diagnostics);
  const bool of_level = event.action == EventAction::Level;
  if (!of_level) refuse_keys(table, {"body", "level"}, because, diagnostics);
  const auto demand = [&](const char* key) {
    if (!table.has(key))
      diagnostics.error("toml.missing-key", event.at, "missing key '" + std::string(key) + "' " + because, "add it");
  };
  const char* needed = of_hinge ? "hinge" : of_constraint ? "constraint" : of_level ? "body" : "controller";
  if (of_hinge || of_constraint || of_controller || of_level) {
    event.target = table.get_string(needed);
    demand(needed);
  }
  if (event.action == EventAction::Switch) {
    event.choice = table.get_int("input", 0);
    demand("input");
  }
  if (of_level) {
    event.choice = table.get_int("level", 0);
    demand("level");
  }
  event.coordinates = table.get_ints("coordinates");
  return event;
}

}  // namespace bough::toml_files
