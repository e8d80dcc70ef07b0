#pragma once
/// \file Models of decks that a test writes out.
#include <memory>
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

/// Deck and model of bulk data, with case control before it or without. Not for errors of reading.
struct TextModel {
  Diagnostics diagnostics;
  const records::Deck deck;
  const Model model;

  explicit TextModel(const std::string& text)
      : deck(nastran::read_deck_text(text, "deck.bdf", {}, diagnostics)), model(build_model(deck, {}, diagnostics)) {}
};

/// Deck and model for static loads: AUTOSPC takes no dof away, enforced displacements are loads.
struct LoadedModel {
  Diagnostics diagnostics;
  records::Deck deck;
  std::unique_ptr<Model> model;

  /// \throws InputError  with the errors of reading
  explicit LoadedModel(const std::string& text) : deck(nastran::read_deck_text(text, "deck.bdf", {}, diagnostics)) {
    diagnostics.throw_if_errors();
    ModelOptions options;
    options.autospc = false;
    options.uses_enforced = true;
    model = std::make_unique<Model>(build_model(deck, options, diagnostics));
  }
};

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
