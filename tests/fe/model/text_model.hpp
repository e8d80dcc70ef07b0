#pragma once
/// \file Models of decks that a test writes out.
#include <string>

#include "fe/model/model.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe::test {

/// The model of bulk data, with case control before it or without; AUTOSPC takes no dof away. Throws InputError with
/// the errors of reading.
inline Model build(const std::string& text, Diagnostics& diagnostics) {
  const auto deck = nastran::read_deck_text(text + "PARAM,AUTOSPC,NO\n", "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  return build_model(deck, {}, diagnostics);
}

inline Model build(const std::string& text) {
  Diagnostics diagnostics;
  return build(text, diagnostics);
}

/// How often reading and building the deck says something with this id.
inline int count(const std::string& text, const std::string& id) {
  Diagnostics diagnostics;
  try {
    build(text, diagnostics);
  } catch (const InputError&) {
  }
  int n = 0;
  for (const auto& d : diagnostics.items()) n += d.id == id ? 1 : 0;
  return n;
}

}  // namespace bough::fe::test
