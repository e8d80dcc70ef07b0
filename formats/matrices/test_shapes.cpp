// Universal files in text: pairs of lines "    -1" around a dataset, its number in the line after the first.
#include "formats/matrices/test_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "formats/matrices/detail/input.hpp"

namespace bough::matrices {
namespace {

using namespace detail;
using Complex = std::complex<double>;

struct Shape {
  double hz = 0, damping = 0;
  std::map<int, Eigen::Matrix<Complex, 6, 1>> values;
};

class UffReader {
 public:
  explicit UffReader(const std::string& path) : in_(path, read_bytes(path)) {}

  TestShapes read() {
    while (in_.next_line()) {
      if (trim(in_.get_line()) != "-1") continue;
      in_.demand_line("the number of a dataset");
      const auto words = split(in_.get_line());
      const auto number = words.empty() ? std::nullopt : parse_integer(words.front());
      if (!number) in_.fail_line("the number of a dataset");
      read_dataset(*number);
    }
    if (shapes_.empty())
      in_.fail("matrices.uff", "no mode shape (dataset 55 of normal or complex modes) in the file",
               "export the shapes of the test as dataset 55");
    return collect();
  }

 private:
  /// False at the end of the dataset.
  bool next() {
    in_.demand_line("the end of the dataset, -1");
    return trim(in_.get_line()) != "-1";
  }
  void demand(const char* expected) {
    if (!next()) in_.fail_line(expected);
  }

  std::vector<long> read_integers(std::size_t width, std::size_t min_count, const char* expected) {
    std::vector<long> values;
    const auto line = in_.get_line();
    for (std::size_t at = 0; at < line.size(); at += width) {
      const auto word = trim(line.substr(at, width));
      if (word.empty()) break;
      const auto value = parse_integer(word);
      if (!value) in_.fail_line(expected);
      values.push_back(*value);
    }
    if (values.size() < min_count) in_.fail_line(expected);
    return values;
  }
  std::vector<double> read_reals(std::size_t width, const char* expected) {
    std::vector<double> values;
    const auto line = in_.get_line();
    for (std::size_t at = 0; at < line.size(); at += width) {
      const auto word = trim(line.substr(at, width));
      if (word.empty()) break;
      const auto value = parse_real(word);
      if (!value || !std::isfinite(*value)) in_.fail_line(expected);
      values.push_back(*value);
    }
    return values;
  }

  void read_dataset(long number) {
    if (number == 15) return read_nodes_15();
    if (number == 2411) return read_nodes_2411();
    if (number == 55) return read_shape();
    while (next()) continue;
  }

  void read_nodes_15() {
    while (next()) {
      const auto line = std::string(in_.get_line());
      const auto id = parse_integer(line.substr(0, 10));
      const auto rest = line.size() > 40 ? line.substr(40) : std::string();
      if (!id) in_.fail_line("a node of dataset 15");
      add_node(*id, read_place(rest, 13));
    }
  }
  void read_nodes_2411() {
    while (next()) {
      const auto head = read_integers(10, 1, "a node of dataset 2411");
      demand("the coordinates of the node");
      add_node(head[0], read_place(std::string(in_.get_line()), 25));
    }
  }
  Eigen::Vector3d read_place(const std::string& text, std::size_t width) {
    Eigen::Vector3d place;
    for (int c = 0; c < 3; ++c) {
      const auto at = width * static_cast<std::size_t>(c);
      const auto value = at < text.size() ? parse_real(text.substr(at, width)) : std::nullopt;
      if (!value) in_.fail_line("three coordinates");
      place[c] = *value;
    }
    return place;
  }
  void add_node(long id, const Eigen::Vector3d& place) { places_[static_cast<int>(id)] = place; }

  void read_shape() {
    const int first_line = in_.get_line_number();
    for (int i = 0; i < 5; ++i) demand("five lines of identification");
    demand("six integers");
    const auto kind =
        read_integers(10, 6, "six integers: model, analysis, characteristic, quantity, data type, number");
    const long analysis = kind[1], data_type = kind[4], count = kind[5];
    const bool is_mode = analysis == 2 || analysis == 3 || analysis == 7;
    if (!is_mode) {
      while (next()) continue;
      return;
    }
    const bool is_complex = data_type == 5 || data_type == 6;
    if ((data_type != 2 && data_type != 4 && !is_complex) || (count != 3 && count != 6))
      in_.fail("matrices.uff",
               "shapes of data type " + std::to_string(data_type) + " with " + std::to_string(count) +
                   " values a node are not read",
               "export three translations or six components, real (2) or complex (5)");
    demand("the integers of the mode");
    demand("the reals of the mode");
    const auto reals = read_reals(13, "the reals of the mode");
    if (reals.empty()) in_.fail_line("the frequency of the mode");
    Shape shape;
    if (analysis == 2) {
      shape.hz = reals[0];
      shape.damping = reals.size() > 2 ? reals[2] : 0;
    } else {
      const Complex pole(reals[0], reals.size() > 1 ? reals[1] : 0);
      shape.hz = std::abs(pole) / (2 * std::numbers::pi);
      shape.damping = std::abs(pole) > 0 ? -pole.real() / std::abs(pole) : 0;
    }
    const auto num_reals = static_cast<std::size_t>(is_complex ? 2 * count : count);
    while (next()) {
      const auto id = read_integers(10, 1, "the number of a node")[0];
      std::vector<double> values;
      while (values.size() < num_reals) {
        demand("the values of the node");
        const auto more = read_reals(13, "values of a node in columns of 13");
        if (more.empty()) in_.fail_line("the values of the node");
        values.insert(values.end(), more.begin(), more.end());
      }
      auto& six = shape.values[static_cast<int>(id)];
      six.setZero();
      for (long c = 0; c < count; ++c) {
        const auto at = static_cast<std::size_t>(c);
        six[c] = is_complex ? Complex(values[2 * at], values[2 * at + 1]) : Complex(values[at], 0);
        if (six[c].imag() != 0) is_complex_ = true;
      }
    }
    if (shape.values.empty())
      in_.fail("matrices.uff", "the shape that begins in line " + std::to_string(first_line) + " has no node",
               "export the shape again");
    shapes_.push_back(std::move(shape));
  }

  TestShapes collect() {
    std::stable_sort(shapes_.begin(), shapes_.end(), [](const Shape& a, const Shape& b) { return a.hz < b.hz; });
    const auto n = static_cast<Eigen::Index>(shapes_.size());
    std::map<int, Eigen::MatrixXcd> phi;
    for (Eigen::Index j = 0; j < n; ++j)
      for (const auto& [id, six] : shapes_[static_cast<std::size_t>(j)].values) {
        auto& rows = phi[id];
        if (rows.size() == 0) rows.setZero(6, n);
        rows.col(j) = six;
      }
    TestShapes test;
    test.is_complex = is_complex_;
    test.frequency_hz.resize(n);
    test.damping.resize(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      test.frequency_hz[j] = shapes_[static_cast<std::size_t>(j)].hz;
      test.damping[j] = shapes_[static_cast<std::size_t>(j)].damping;
    }
    if (!places_.empty()) test.node_xyz.resize(static_cast<Eigen::Index>(phi.size()), 3);
    for (const auto& [id, rows] : phi) {
      if (!places_.empty()) {
        const auto place = places_.find(id);
        if (place == places_.end())
          in_.fail("matrices.uff", "node " + std::to_string(id) + " of a shape has no coordinates in the file",
                   "export all nodes as dataset 15 or 2411");
        test.node_xyz.row(static_cast<Eigen::Index>(test.node_id.size())) = place->second.transpose();
      }
      test.node_id.push_back(id);
      test.phi.push_back(rows);
    }
    return test;
  }

  TextInput in_;
  std::map<int, Eigen::Vector3d> places_;
  std::vector<Shape> shapes_;
  bool is_complex_ = false;
};

}  // namespace

TestShapes read_test_shapes(const std::string& path) { return UffReader(path).read(); }

}  // namespace bough::matrices
