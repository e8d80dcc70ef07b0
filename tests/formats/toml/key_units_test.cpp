/// Dimensions of the keys in data/schema: how they are evaluated, and that convert knows every word in them.
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/toml/detail/schema.hpp"
#include "formats/toml/detail/schema_json.hpp"
#include "formats/toml/detail/unit_expression.hpp"

namespace bough::toml_files {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Units find(const std::string& name) {
  if (name == "L") return {1000};
  if (name == "T") return {4};
  if (name == "effort") return {6, 12};
  if (name == "travel") return {3, 2};
  if (name == "exponent") return {0.5};
  return {};
}

TEST(KeyUnits, AreProductsOfPowers) {
  EXPECT_THAT(calc_units("1", find), ElementsAre(1));
  EXPECT_THAT(calc_units("L/T^2", find), ElementsAre(1000.0 / 16));
  EXPECT_THAT(calc_units("L T^0.5", find), ElementsAre(2000));
  EXPECT_THAT(calc_units("L/T/T", find), ElementsAre(1000.0 / 16));
  EXPECT_THAT(calc_units("1/T^exponent", find), ElementsAre(0.5));
}

TEST(KeyUnits, HaveAComponentOrAnEntryEach) {
  EXPECT_THAT(calc_units("effort/travel", find), ElementsAre(2, 6));
  EXPECT_THAT(calc_units("effort T^2/travel", find), ElementsAre(32, 96));
  EXPECT_THAT(calc_units("1/T, T", find), ElementsAre(0.25, 4));
}

TEST(KeyUnits, OfUnknownNamesAreNone) {
  EXPECT_THAT(calc_units("L signal", find), IsEmpty());
  EXPECT_THAT(calc_units("1/T, signal", find), IsEmpty());
  EXPECT_THAT(calc_units("L^power", find), IsEmpty());
}

TEST(KeyUnits, DependOnTheTypeOfTheTable) {
  const auto key = nlohmann::json::parse(R"({"dims": {"contact": "T/L", "*": "F T/L"}})");
  EXPECT_EQ(get_dims(key, "contact"), "T/L");
  EXPECT_EQ(get_dims(key, "spring"), "F T/L");
  EXPECT_EQ(get_dims(nlohmann::json::parse(R"({"dims": {"pid": "out"}})"), "gain"), "");
  EXPECT_EQ(get_dims(nlohmann::json::parse(R"({"type": "number"})"), "gain"), "");
}

/// Calls act(text) for each dimension below a schema.
template <class Act>
void visit_dims(const nlohmann::json& schema, const Act& act) {
  if (schema.is_object())
    for (const auto& [key, value] : schema.items()) {
      if (key != "dims" || (value.is_object() && value.contains("description"))) {
        visit_dims(value, act);
      } else if (value.is_string()) {
        act(value.template get<std::string>());
      } else {
        for (const auto& text : value) act(text.template get<std::string>());
      }
    }
  else if (schema.is_array())
    for (const auto& item : schema) visit_dims(item, act);
}

TEST(KeyUnits, OfTheSchemasUseWordsOfConvert) {
  const std::set<std::string> forms{"angle", "one", "factor", "six", "columns", "polynomial", "formula", "list"};
  const std::set<std::string> words{"1",      "M",      "L",        "T",     "F",    "E",      "q",
                                    "travel", "rate",   "in",       "in2",   "last", "inputs", "out",
                                    "step",   "effort", "signal",   "value", "x",    "first",  "command",
                                    "angle",  "mixed",  "exponent", "power"};
  int count = 0;
  for (const char* text : {get_system_schema(), get_body_schema()})
    visit_dims(nlohmann::json::parse(text), [&](std::string dims) {
      ++count;
      if (const auto colon = dims.find(':'); colon != std::string::npos) {
        EXPECT_EQ(forms.count(dims.substr(0, colon)), 1u) << dims;
        dims = dims.substr(colon + 1);
      }
      for (char& c : dims) c = c == '/' || c == '^' || c == ',' ? ' ' : c;
      std::istringstream in(dims);
      for (std::string word; in >> word;)
        EXPECT_TRUE(words.count(word) > 0 || word.find_first_not_of("0123456789.") == std::string::npos) << word;
    });
  EXPECT_GT(count, 150);
}

}  // namespace
}  // namespace bough::toml_files
