#pragma once
/// \file Output of `compare`: arrays by path, each with its description.
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace bough::records {

struct ComparisonArray {
  std::string path;
  Eigen::MatrixXd values;  ///< a vector has one column
  std::string description, dims;
};

struct Comparison {
  std::vector<std::pair<std::string, std::string>> source;  ///< (file name, SHA-256)
  std::vector<ComparisonArray> arrays;
  std::vector<std::pair<std::string, std::vector<std::string>>> words;  ///< path, list
};

}  // namespace bough::records
