#pragma once
/// \file Objects of JSON from the members of records.
#include <functional>
#include <nlohmann/json.hpp>

namespace bough::cli {

/// End of the pairs.
inline void put_members(nlohmann::json&, const auto&) {}
/// Sets row[name] to the value of a member of the record, then the pairs of names and members that follow.
template <class Record, class Member, class... Rest>
void put_members(nlohmann::json& row, const Record& record, const char* name, Member member, const Rest&... rest) {
  row[name] = std::invoke(member, record);
  put_members(row, record, rest...);
}

/// An array with an object per record: pairs of a name and a member.
template <class Records, class... Members>
nlohmann::json make_rows(const Records& records, const Members&... members) {
  auto rows = nlohmann::json::array();
  for (const auto& record : records) put_members(rows.emplace_back(nlohmann::json::object()), record, members...);
  return rows;
}

}  // namespace bough::cli
