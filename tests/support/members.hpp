#pragma once
/// \file Records compared member by member.
#include <gtest/gtest.h>

namespace bough::test {

/// EXPECTs that these members of two records are equal; a failure tells the place in the list.
template <class Record, class... Members>
void expect_same_members(const Record& found, const Record& expected, Members Record::*... members) {
  int place = 0;
  const auto compare = [&](const auto member) { EXPECT_EQ(found.*member, expected.*member) << "member " << ++place; };
  (compare(members), ...);
}

}  // namespace bough::test
