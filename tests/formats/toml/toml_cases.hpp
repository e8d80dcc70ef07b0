#pragma once
/// \file Bad documents, each with the id, line and words that its error has to carry.
#include <string>
#include <vector>

namespace bough::test {

/// Complete and valid; every kind of table.
extern const char* const kGoodSystem;
extern const char* const kGoodBody;

struct BadDocument {
  std::string id;         ///< of the one error
  std::string old_text;   ///< replaced in the good document ...
  std::string new_text;   ///< ... by this
  std::string words;      ///< part of the message
  bool by_schema = true;  ///< the JSON Schema refuses it too; otherwise only Bough can tell
};
std::vector<BadDocument> get_bad_systems();
std::vector<BadDocument> get_bad_bodies();

/// The good document with the replacement; fails the test when old_text does not occur exactly once.
std::string make_document(const std::string& good, const BadDocument& bad);

}  // namespace bough::test
