#pragma once
/// \file Members of records as columns of a file.
#include <vector>

#include <Eigen/Dense>

namespace bough::hdf5 {

/// One member of all records.
template <class Record, class Member>
std::vector<Member> collect(const std::vector<Record>& records, Member Record::*member) {
  std::vector<Member> values;
  for (const auto& record : records) values.push_back(record.*member);
  return values;
}

/// The values as a vector of Eigen.
inline Eigen::VectorXd to_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace bough::hdf5
