// Universal files in text: pairs of lines "    -1" around a dataset, its number in the line after the first.
#include "formats/matrices/test_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "formats/matrices/detail/uff_input.hpp"

namespace bough::matrices {
namespace {

using namespace detail;
using Complex = std::complex<double>;

/// Coordinate system of the file: x_file = R x_local + origin.
struct LocalSystem {
  int type = 0;  ///< 0 Cartesian, 1 cylindrical, 2 spherical
  int reference = 0;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  int line = 0;
};

struct NodePlace {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< in the definition system
  long definition = 0, displacement = 0;        ///< systems
};

struct Shape {
  double hz = 0, damping = 0;
  std::map<int, Eigen::Matrix<Complex, 6, 1>> values;
};

class UffReader {
 public:
  explicit UffReader(const std::string& path) : in_(path) {}

  TestShapes read() {
    in_.read_datasets([&](long number) { read_dataset(number); });
    if (shapes_.empty())
      in_.fail("matrices.uff", "no mode shape (dataset 55 of normal or complex modes) in the file",
               "export the shapes of the test as dataset 55");
    return collect();
  }

 private:
  /// Numbers in columns of the present line, up to a blank one; parse(word) gives none for a word that is no number.
  template <class Parse>
  auto read_columns(std::size_t width, const char* expected, const Parse& parse) {
    std::vector<typename decltype(parse(std::string_view()))::value_type> values;
    const auto line = in_.get_line();
    for (std::size_t at = 0; at < line.size(); at += width) {
      const auto word = trim(line.substr(at, width));
      if (word.empty()) break;
      const auto value = parse(word);
      if (!value) in_.fail_line(expected);
      values.push_back(*value);
    }
    return values;
  }
  std::vector<long> read_integers(std::size_t width, std::size_t min_count, const char* expected) {
    auto values = read_columns(width, expected, [](std::string_view word) { return parse_integer(word); });
    if (values.size() < min_count) in_.fail_line(expected);
    return values;
  }
  std::vector<double> read_reals(std::size_t width, const char* expected) {
    return read_columns(width, expected, [](std::string_view word) {
      const auto value = parse_real(word);
      return value && std::isfinite(*value) ? value : std::nullopt;
    });
  }

  void read_dataset(long number) {
    if (number == 15) return read_nodes_15();
    if (number == 2411) return read_nodes_2411();
    if (number == 55) return read_shape();
    if (number == 18) return read_systems_18();
    if (number == 2420) return read_systems_2420();
    in_.skip_dataset();
  }

  void read_nodes_15() {
    while (in_.next_of_dataset()) {
      const auto line = std::string(in_.get_line());
      const auto id = parse_integer(line.substr(0, 10));
      const auto rest = line.size() > 40 ? line.substr(40) : std::string();
      if (!id || line.size() < 30) in_.fail_line("a node of dataset 15");
      const auto definition = parse_integer(line.substr(10, 10)), displacement = parse_integer(line.substr(20, 10));
      places_[static_cast<int>(*id)] = {read_place(rest, 13), definition.value_or(0), displacement.value_or(0)};
    }
  }
  void read_nodes_2411() {
    while (in_.next_of_dataset()) {
      const auto head = read_integers(10, 1, "a node of dataset 2411");
      in_.demand_of_dataset("the coordinates of the node");
      places_[static_cast<int>(head[0])] = {read_place(std::string(in_.get_line()), 25), head.size() > 1 ? head[1] : 0,
                                            head.size() > 2 ? head[2] : 0};
    }
  }
  /// Number, type and reference; name; origin, a point on the x axis, a point of the xz plane.
  void read_systems_18() {
    while (in_.next_of_dataset()) {
      const auto head = read_integers(10, 3, "a coordinate system of dataset 18");
      LocalSystem system;
      system.type = static_cast<int>(head[1]);
      system.reference = static_cast<int>(head[2]);
      system.line = in_.get_line_number();
      in_.demand_of_dataset("the name of the coordinate system");
      std::vector<double> values;
      while (values.size() < 9) {
        in_.demand_of_dataset("nine coordinates of three points");
        const auto more = read_reals(13, "nine coordinates of three points");
        if (more.empty()) in_.fail_line("nine coordinates of three points");
        values.insert(values.end(), more.begin(), more.end());
      }
      const Eigen::Map<const Eigen::Matrix3d> points(values.data());
      system.origin = points.col(0);
      const Eigen::Vector3d x = points.col(1) - system.origin, in_plane = points.col(2) - system.origin;
      const Eigen::Vector3d y = in_plane.cross(x);
      if (!(y.norm() > 1e-6 * x.norm() * in_plane.norm())) in_.fail_line("three points that are not on one line");
      system.R.col(0) = x.normalized();
      system.R.col(1) = y.normalized();
      system.R.col(2) = system.R.col(0).cross(system.R.col(1));
      systems_[head[0]] = system;
    }
  }
  /// Part and its name; then number, type and colour, name, three rows with the axes, one with the origin.
  void read_systems_2420() {
    in_.demand_of_dataset("the part of the coordinate systems");
    in_.demand_of_dataset("the name of the part");
    while (in_.next_of_dataset()) {
      const auto head = read_integers(10, 2, "a coordinate system of dataset 2420");
      LocalSystem system;
      system.type = static_cast<int>(head[1]);
      system.line = in_.get_line_number();
      in_.demand_of_dataset("the name of the coordinate system");
      for (int row = 0; row < 4; ++row) {
        in_.demand_of_dataset("four rows of a transformation matrix");
        const Eigen::Vector3d values = read_place(std::string(in_.get_line()), 25);
        if (row < 3)
          system.R.col(row) = values;
        else
          system.origin = values;
      }
      if (!((system.R.transpose() * system.R).isIdentity(1e-4) && system.R.determinant() > 0))
        in_.fail("matrices.uff", "the axes of coordinate system " + std::to_string(head[0]) + " are not orthonormal",
                 "export the coordinate system again");
      systems_[head[0]] = system;
    }
  }

  /// System `id`; nullptr: the axes of the file, which are 0, and 1 unless the file has a system 1.
  const LocalSystem* find_system(long id, int node) const {
    const auto found = systems_.find(id);
    if (found == systems_.end()) {
      if (id == 0 || id == 1) return nullptr;
      in_.fail("matrices.uff",
               "node " + std::to_string(node) + " refers to coordinate system " + std::to_string(id) +
                   ", which the file does not define",
               "export the coordinate systems too (dataset 2420 or 18)");
    }
    const auto& system = found->second;
    if (system.type < 0 || system.type > 2 || (system.reference != 0 && system.reference != 1) ||
        (system.reference == 1 && id != 1 && systems_.count(1) > 0))
      in_.fail("matrices.uff",
               "coordinate system " + std::to_string(id) + " of line " + std::to_string(system.line) + " is of type " +
                   std::to_string(system.type) + " in system " + std::to_string(system.reference),
               "export Cartesian, cylindrical or spherical systems in the axes of the file");
    return &system;
  }

  Eigen::Vector3d calc_place(int node, const NodePlace& place) const {
    const auto* system = find_system(place.definition, node);
    if (!system) return place.x;
    constexpr double kDegree = std::numbers::pi / 180;
    const auto& c = place.x;
    Eigen::Vector3d x = c;
    if (system->type == 1)
      x << c[0] * std::cos(kDegree * c[1]), c[0] * std::sin(kDegree * c[1]), c[2];
    else if (system->type == 2)
      x << c[0] * std::sin(kDegree * c[1]) * std::cos(kDegree * c[2]),
          c[0] * std::sin(kDegree * c[1]) * std::sin(kDegree * c[2]), c[0] * std::cos(kDegree * c[1]);
    return system->R * x + system->origin;
  }

  /// Axes of the components of a node: (radial, tangential, z) and (radial, θ, φ) where it is.
  Eigen::Matrix3d calc_axes(int node, const NodePlace& place) const {
    const auto* system = find_system(place.displacement, node);
    if (!system) return Eigen::Matrix3d::Identity();
    if (system->type == 0) return system->R;
    const Eigen::Vector3d x = system->R.transpose() * (calc_place(node, place) - system->origin);
    const double r = std::hypot(x[0], x[1]);
    if (!(r > 1e-9 * x.norm()))
      in_.fail("matrices.uff",
               "node " + std::to_string(node) + " is on the axis of its displacement system " +
                   std::to_string(place.displacement),
               "give the node a Cartesian system");
    const double c = x[0] / r, s = x[1] / r;
    Eigen::Matrix3d axes;
    axes << c, -s, 0, s, c, 0, 0, 0, 1;
    if (system->type == 2) {
      const double cos_theta = x[2] / x.norm(), sin_theta = r / x.norm();
      axes << sin_theta * c, cos_theta * c, -s, sin_theta * s, cos_theta * s, c, cos_theta, -sin_theta, 0;
    }
    return system->R * axes;
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
  void read_shape() {
    const int first_line = in_.get_line_number();
    for (int i = 0; i < 5; ++i) in_.demand_of_dataset("five lines of identification");
    in_.demand_of_dataset("six integers");
    const auto kind =
        read_integers(10, 6, "six integers: model, analysis, characteristic, quantity, data type, number");
    const long analysis = kind[1], data_type = kind[4], count = kind[5];
    const bool is_mode = analysis == 2 || analysis == 3 || analysis == 7;
    if (!is_mode) {
      in_.skip_dataset();
      return;
    }
    const bool is_complex = data_type == 5 || data_type == 6;
    if ((data_type != 2 && data_type != 4 && !is_complex) || (count != 3 && count != 6))
      in_.fail("matrices.uff",
               "shapes of data type " + std::to_string(data_type) + " with " + std::to_string(count) +
                   " values a node are not read",
               "export three translations or six components, real (2) or complex (5)");
    in_.demand_of_dataset("the integers of the mode");
    in_.demand_of_dataset("the reals of the mode");
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
    while (in_.next_of_dataset()) {
      const auto id = read_integers(10, 1, "the number of a node")[0];
      std::vector<double> values;
      while (values.size() < num_reals) {
        in_.demand_of_dataset("the values of the node");
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

  /// A component that was not measured is no component along other axes.
  void demand_measured(int id, const NodePlace& place, const Eigen::Matrix3d& axes,
                       const Eigen::MatrixXcd& rows) const {
    if ((axes.array() != 0).count() == 3) return;
    for (const int half : {0, 3}) {
      if (rows.middleRows(half, 3).isZero(0)) continue;
      for (int c = half; c < half + 3; ++c)
        if (rows.row(c).isZero(0))
          in_.fail("matrices.uff",
                   "component " + std::to_string(c + 1) + " of node " + std::to_string(id) +
                       " is zero in all shapes, and its displacement system " + std::to_string(place.displacement) +
                       " is oblique to the axes of the file",
                   "measure three components there, or remove the node");
    }
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
        test.node_xyz.row(static_cast<Eigen::Index>(test.node_id.size())) = calc_place(id, place->second).transpose();
        const Eigen::Matrix3d axes =
            calc_axes(id, place->second).unaryExpr([](double c) { return std::abs(c) < 1e-9 ? 0.0 : c; });
        demand_measured(id, place->second, axes, rows);
        test.phi.emplace_back(6, n);
        test.phi.back() << axes * rows.topRows(3), axes * rows.bottomRows(3);
      } else {
        test.phi.push_back(rows);
      }
      test.node_id.push_back(id);
    }
    return test;
  }

  UffInput in_;
  std::map<int, NodePlace> places_;
  std::map<long, LocalSystem> systems_;
  std::vector<Shape> shapes_;
  bool is_complex_ = false;
};

}  // namespace

TestShapes read_test_shapes(const std::string& path) { return UffReader(path).read(); }

}  // namespace bough::matrices
