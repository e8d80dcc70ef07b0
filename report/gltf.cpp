#include "report/gltf.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/diagnostic.hpp"

namespace bough::report {

namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "glTF is little endian");

constexpr int kFloat = 5126, kUnsigned = 5125, kVertices = 34962, kIndices = 34963;
constexpr int kPoints = 0, kLines = 1, kTriangles = 4;
constexpr int kSteps = 48;  // key frames of a swing

/// The buffer with its views and accessors.
class Buffer {
 public:
  json views = json::array(), accessors = json::array();

  /// Rows one after another as floats; target 0: key frames, which have none. Returns the accessor.
  int add_floats(const Eigen::MatrixXd& rows, const std::string& type, int target, bool has_bounds) {
    const auto first = bytes_.size();
    json low = json::array(), high = json::array();
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      for (Eigen::Index j = 0; j < rows.cols(); ++j) put(static_cast<float>(rows(i, j)));
    for (Eigen::Index j = 0; has_bounds && j < rows.cols(); ++j) {
      // Bounds of the numbers as written, in single precision.
      low.push_back(static_cast<double>(static_cast<float>(rows.col(j).minCoeff())));
      high.push_back(static_cast<double>(static_cast<float>(rows.col(j).maxCoeff())));
    }
    const auto count = type == "SCALAR" ? rows.size() : rows.rows();
    json accessor{{"bufferView", add_view(first, target)}, {"componentType", kFloat}, {"count", count}, {"type", type}};
    if (has_bounds) accessor["min"] = low, accessor["max"] = high;
    accessors.push_back(std::move(accessor));
    return static_cast<int>(accessors.size()) - 1;
  }

  int add_indices(const std::vector<std::uint32_t>& indices) {
    const auto first = bytes_.size();
    for (const auto i : indices) put(i);
    accessors.push_back({{"bufferView", add_view(first, kIndices)},
                         {"componentType", kUnsigned},
                         {"count", indices.size()},
                         {"type", "SCALAR"}});
    return static_cast<int>(accessors.size()) - 1;
  }

  const std::string& get_bytes() const { return bytes_; }

 private:
  template <class Number>
  void put(Number value) {
    static_assert(sizeof value == 4);
    char four[4];
    std::memcpy(four, &value, 4);
    bytes_.append(four, 4);
  }
  int add_view(std::size_t first, int target) {
    json view{{"buffer", 0}, {"byteOffset", first}, {"byteLength", bytes_.size() - first}};
    if (target != 0) view["target"] = target;
    views.push_back(std::move(view));
    return static_cast<int>(views.size()) - 1;
  }

  std::string bytes_;
};

/// Okabe & Ito, as linear light.
json make_material(std::size_t i) {
  static constexpr std::array<std::array<double, 3>, 6> kColors{{{0.000, 0.168, 0.445},
                                                                 {0.665, 0.112, 0.000},
                                                                 {0.000, 0.342, 0.171},
                                                                 {0.604, 0.191, 0.386},
                                                                 {0.092, 0.456, 0.815},
                                                                 {0.791, 0.347, 0.000}}};
  const auto& c = kColors[i % kColors.size()];
  return {{"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {c[0], c[1], c[2], 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}};
}

json make_mesh(const GltfBody& body, std::size_t material, Buffer& buffer) {
  const auto& drawing = body.drawing;
  const json attributes{{"POSITION", buffer.add_floats(drawing.xyz, "VEC3", kVertices, true)}};
  json targets = json::array();
  for (const auto& shape : drawing.shapes)
    targets.push_back({{"POSITION", buffer.add_floats(shape, "VEC3", kVertices, true)}});
  json primitives = json::array();
  const auto add = [&](int mode, const std::vector<std::uint32_t>& indices) {
    json primitive{{"attributes", attributes}, {"mode", mode}, {"material", material}};
    if (!indices.empty()) primitive["indices"] = buffer.add_indices(indices);
    if (!targets.empty()) primitive["targets"] = targets;
    primitives.push_back(std::move(primitive));
  };
  if (!drawing.triangles.empty()) add(kTriangles, drawing.triangles);
  if (!drawing.edges.empty()) add(kLines, drawing.edges);
  if (drawing.triangles.empty() && drawing.edges.empty()) add(kPoints, {});
  json mesh{{"name", body.name}, {"primitives", std::move(primitives)}};
  if (!drawing.shapes.empty()) {
    mesh["weights"] = json::array();
    for (std::size_t j = 0; j < drawing.shapes.size(); ++j)
      mesh["weights"].push_back(body.weights.rows() > 0 ? body.weights(0, static_cast<Eigen::Index>(j)) : 0.0);
  }
  return mesh;
}

struct Animation {
  json samplers = json::array(), channels = json::array();
  void add(int input, int output, std::size_t node, const std::string& path) {
    channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers.push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
  }
  json take(const std::string& name) {
    return {{"name", name}, {"samplers", std::move(samplers)}, {"channels", std::move(channels)}};
  }
};

/// Samples that are a float's step or more after the one before; times from the first.
std::vector<Eigen::Index> choose_frames(const Eigen::VectorXd& time) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < time.size(); ++i)
    if (kept.empty() || static_cast<float>(time[i] - time[0]) > static_cast<float>(time[kept.back()] - time[0]))
      kept.push_back(i);
  return kept;
}

/// x y z w, of unit length, and of the sign that is nearer to the one before.
Eigen::MatrixXd turn_quaternions(const Eigen::MatrixXd& wxyz) {
  Eigen::MatrixXd q(wxyz.rows(), 4);
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    q.row(i) << wxyz(i, 1), wxyz(i, 2), wxyz(i, 3), wxyz(i, 0);
    q.row(i).normalize();
    if (i > 0 && q.row(i).dot(q.row(i - 1)) < 0) q.row(i) *= -1;
  }
  return q;
}

json make_motion(const GltfScene& scene, Buffer& buffer) {
  const auto frames = choose_frames(scene.time);
  const Eigen::VectorXd from_zero = scene.time.array() - scene.time[0];
  const int input = buffer.add_floats(from_zero(frames), "SCALAR", 0, true);
  Animation animation;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    animation.add(input, buffer.add_floats(body.position(frames, Eigen::all), "VEC3", 0, false), b, "translation");
    animation.add(input, buffer.add_floats(turn_quaternions(body.rotation)(frames, Eigen::all), "VEC4", 0, false), b,
                  "rotation");
    if (!body.drawing.shapes.empty())
      animation.add(input, buffer.add_floats(body.weights(frames, Eigen::all), "SCALAR", 0, false), b, "weights");
  }
  return json::array({animation.take(scene.name.empty() ? "run" : scene.name)});
}

/// Each shape swings alone, by a sine.
json make_swings(const GltfScene& scene, Buffer& buffer) {
  json animations = json::array();
  if (scene.bodies.empty()) return animations;
  const auto n = static_cast<Eigen::Index>(scene.bodies.front().drawing.shapes.size());
  const int input = buffer.add_floats(Eigen::VectorXd::LinSpaced(kSteps + 1, 0, scene.shape_period), "SCALAR", 0, true);
  for (Eigen::Index j = 0; j < n; ++j) {
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(kSteps + 1, n);
    for (int k = 0; k <= kSteps; ++k) weights(k, j) = std::sin(2 * std::numbers::pi * k / kSteps);
    Animation animation;
    animation.add(input, buffer.add_floats(weights, "SCALAR", 0, false), 0, "weights");
    const auto at = static_cast<std::size_t>(j);
    animations.push_back(
        animation.take(at < scene.shape_names.size() ? scene.shape_names[at] : "mode " + std::to_string(j + 1)));
  }
  return animations;
}

void put_word(std::string& out, std::uint32_t value) {
  char four[4];
  std::memcpy(four, &value, 4);
  out.append(four, 4);
}

}  // namespace

std::string make_glb(const GltfScene& scene) {
  Buffer buffer;
  json nodes = json::array(), meshes = json::array(), materials = json::array(), roots = json::array();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    BOUGH_DEMAND(body.drawing.xyz.rows() > 0);
    meshes.push_back(make_mesh(body, b, buffer));
    materials.push_back(make_material(b));
    json node{{"name", body.name}, {"mesh", b}};
    if (body.position.rows() > 0) {
      const auto q = turn_quaternions(body.rotation.topRows(1));
      node["translation"] = {body.position(0, 0), body.position(0, 1), body.position(0, 2)};
      node["rotation"] = {q(0, 0), q(0, 1), q(0, 2), q(0, 3)};
    }
    nodes.push_back(std::move(node));
    roots.push_back(b);
  }
  json root{{"asset", {{"version", "2.0"}, {"generator", "Bough"}}},
            {"scene", 0},
            {"scenes", json::array({{{"name", scene.name}, {"nodes", roots}}})},
            {"nodes", nodes},
            {"meshes", meshes},
            {"materials", materials}};
  auto animations = scene.time.size() > 0 ? make_motion(scene, buffer) : make_swings(scene, buffer);
  if (!animations.empty()) root["animations"] = std::move(animations);
  if (scene.time.size() > 0) root["extras"] = {{"first_time", scene.time[0]}};
  root["accessors"] = buffer.accessors;
  root["bufferViews"] = buffer.views;
  root["buffers"] = json::array({{{"byteLength", buffer.get_bytes().size()}}});
  std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto& bytes = buffer.get_bytes();  // of four bytes a number
  const auto whole = 12 + 8 + text.size() + 8 + bytes.size();
  if (whole > 0xFFFFFFFFU)
    throw InputError("cli.bad-range", {}, "the file would have more than 4 GiB, the most that .glb can say",
                     "choose fewer samples with --every or --window");
  std::string out = "glTF";
  put_word(out, 2);
  put_word(out, static_cast<std::uint32_t>(whole));
  put_word(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  put_word(out, static_cast<std::uint32_t>(bytes.size()));
  out.append("BIN\0", 4);
  return out + bytes;
}

}  // namespace bough::report
