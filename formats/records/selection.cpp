#include "formats/records/selection.hpp"

namespace bough::records {

CardLocation find_selection(const Deck& deck, const std::string& command, int set) {
  static const std::map<std::string, int Subcase::*> sets{{"SPC", &Subcase::spc},
                                                          {"MPC", &Subcase::mpc},
                                                          {"LOAD", &Subcase::load},
                                                          {"TEMPERATURE", &Subcase::temperature},
                                                          {"METHOD", &Subcase::method},
                                                          {"SUPORT1", &Subcase::suport1},
                                                          {"STATSUB", &Subcase::statsub},
                                                          {"NSM", &Subcase::nsm},
                                                          {"TEMPERATURE(INITIAL)", &Subcase::initial_temperature},
                                                          {"TEMPERATURE(MATERIAL)", &Subcase::material_temperature}};
  const auto selected = sets.at(command);
  for (const auto& subcase : deck.subcases)
    if (subcase.*selected == set) return subcase.find_command(command);
  return {};
}

}  // namespace bough::records
