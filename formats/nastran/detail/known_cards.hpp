#pragma once
/// \file Bulk data names of the Nastran family and the effect of each card.
#include <optional>
#include <string>
#include <string_view>

#include "formats/records/deck.hpp"

namespace bough::nastran::detail {

/// Effect of a card (upper case); nothing when no Nastran has such a card.
std::optional<records::CardEffect> find_effect(std::string_view name);
/// The known or read name nearest to `name`, or empty.
std::string find_nearest_card(std::string_view name);
/// The command that selects a static load which is not read, by the set in its first field; empty for other cards.
std::string_view find_selecting_command(std::string_view name);
/// Effect of a set of dofs that is read but not used, or nullptr for other cards.
const char* find_loss(std::string_view name);
/// Cards that act in responses alone. Those that a command selects, which is refused itself, are no error.
struct ResponseEffect {
  const char* what;  ///< "gives ...", or the command that selects the card
  bool needs_command;
  const char* without;  ///< what is computed with --ignore
};
/// Returns the effect of a card that acts in responses alone; none for other cards.
std::optional<ResponseEffect> find_response_effect(std::string_view name);
/// Kind of card that another makes dependent on temperature (MATTi).
enum class CardBase { None, Material };
/// Returns the kind of card that `name` makes dependent on temperature.
CardBase find_base(std::string_view name);
/// Returns the effect as a noun, "stiffness" or "a constraint".
const char* get_effect_name(records::CardEffect effect);

}  // namespace bough::nastran::detail
