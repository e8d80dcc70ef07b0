// Two free bodies joined by a hinge, as a hinge of the tree and as a constraint between them, and gears and a rack on a
// free body: momenta, energy against what dampers take, and what the hinge holds, from the poses of the bodies alone.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

/// Pose of Hc in Hp.
struct Pose {
  Matrix3d R;
  Vector3d p;
};

struct Joint {
  const char* name;
  HingeType type;
  const char* rotations;
  int num_coordinates;
  /// Distance of the pose, or of that of given coordinates, from those that the hinge allows.
  std::function<double(const Pose&, const VectorXd& q)> calc_residual;
};

const Vector3d kAxis = Vector3d(0.3, -0.5, 0.9).normalized(), kAxis2 = Vector3d(0.8, 0.4, 0.1).normalized();
constexpr double kPitch = 0.35;

Matrix3d turn(char axis, double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::Unit(axis - 'x')).toRotationMatrix();
}

std::vector<Joint> make_joints() {
  const auto about = [](const Vector3d& axis, double angle) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  const auto euler = [](const std::string& axes) {
    return [axes](const Pose& x, const VectorXd& q) {
      return x.p.norm() + (x.R - turn(axes[0], q[0]) * turn(axes[1], q[1]) * turn(axes[2], q[2])).norm();
    };
  };
  return {
      {"screw", HingeType::Screw, "", 1,
       [=](const Pose& x, const VectorXd& q) {
         const double travel = kAxis.dot(x.p);
         return (x.p - travel * kAxis).norm() + (x.R - about(kAxis, travel / kPitch)).norm() +
                std::abs(travel - kPitch * q[0]);
       }},
      {"universal", HingeType::Universal, "", 2,
       [=](const Pose& x, const VectorXd& q) {
         return x.p.norm() + std::abs(kAxis.dot(x.R * kAxis2) - kAxis.dot(kAxis2)) +
                (x.R - about(kAxis, q[0]) * about(kAxis2, q[1])).norm();
       }},
      {"planar", HingeType::Planar, "", 3,
       [=](const Pose& x, const VectorXd& q) {
         return std::abs(kAxis.dot(x.p)) + (x.R * kAxis - kAxis).norm() + (x.R - about(kAxis, q[2])).norm() +
                std::abs(x.p.norm() - std::hypot(q[0], q[1]));
       }},
      {"gimbal", HingeType::General, "xyz", 3, euler("xyz")},
      {"euler", HingeType::General, "zxz", 3, euler("zxz")},
  };
}

constexpr double kStiffness = 3, kDamping = 0.4;

/// "child" on "base", which flies.
records::SystemSpec make_pair(const Joint& joint, bool has_damper) {
  Random random(11);
  records::SystemSpec spec;
  spec.bodies = {make_rigid_record("base", random), make_rigid_record("child", random)};
  spec.hinges = {make_hinge_record("root", HingeType::Free, "ground", "base"),
                 make_hinge_record("joint", joint.type, "base", "child")};
  spec.hinges[0].rate = {0.3, -0.5, 0.4, 0.2, 0.1, -0.3};
  auto& h = spec.hinges[1];
  h.rotations = joint.rotations;
  h.axis = kAxis;
  h.axis2 = kAxis2;
  h.pitch = kPitch;
  h.parent_position = random.vector();
  h.child_position = random.vector();
  h.parent_rotation = random.rotation();
  h.child_rotation = random.rotation();
  for (int i = 0; i < joint.num_coordinates; ++i) {
    h.position.push_back(0.4 + 0.3 * i);
    h.rate.push_back(1.1 - 0.6 * i);
    h.stiffness.push_back(kStiffness);
    h.null_position.push_back(0.8);  // away from where axes of gimbals meet
    if (has_damper) h.damping.push_back(kDamping);
  }
  spec.simulation.duration = 2;
  spec.simulation.output_step = 0.01;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  return spec;
}

std::vector<Pose> get_poses(const MemorySink& sink, const std::string& body, const Vector3d& p, const Matrix3d& R) {
  const MatrixXd q = sink.get("/bodies/" + body + "/quaternion"), at = sink.get("/bodies/" + body + "/position");
  std::vector<Pose> poses;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Matrix3d R_WB = Eigen::Quaterniond(q(i, 0), q(i, 1), q(i, 2), q(i, 3)).toRotationMatrix();
    poses.push_back({R_WB * R, Vector3d(at.row(i)) + R_WB * p});
  }
  return poses;
}

std::vector<Pose> get_relative(const MemorySink& sink, const records::SystemSpec& spec) {
  const auto& h = spec.hinges[1];
  const auto parent = get_poses(sink, "base", h.parent_position, h.parent_rotation),
             child = get_poses(sink, "child", h.child_position, h.child_rotation);
  std::vector<Pose> relative;
  for (size_t i = 0; i < parent.size(); ++i)
    relative.push_back({parent[i].R.transpose() * child[i].R, parent[i].R.transpose() * (child[i].p - parent[i].p)});
  return relative;
}

void expect_momenta_hold(const MemorySink& sink, double allowed) {
  for (const std::string which : {"/momentum/linear", "/momentum/angular"}) {
    const MatrixXd m = sink.get(which);
    EXPECT_GT(m.row(0).norm(), 0.1);
    EXPECT_LT((m.rowwise() - m.row(0)).cwiseAbs().maxCoeff(), allowed) << which;
  }
}

/// ∫ c q̇² by Simpson's rule on the samples.
double calc_heat(const MemorySink& sink, const std::string& hinge) {
  const MatrixXd u = sink.get("/hinges/" + hinge + "/qdot");
  const auto n = u.rows() - 1;
  double sum = 0;
  for (Eigen::Index i = 0; i <= n; ++i)
    sum += (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) * kDamping * u.row(i).squaredNorm();
  return sum * (sink.time()[1] - sink.time()[0]) / 3;
}

TEST(HingesInMotion, KeepMomentaAndTheirShapeAndGiveDampersTheirHeat) {
  for (const Joint& joint : make_joints()) {
    SCOPED_TRACE(joint.name);
    for (const bool has_damper : {false, true}) {
      const auto spec = make_pair(joint, has_damper);
      const MemorySink sink = run_kept(spec, 1e-11);
      expect_momenta_hold(sink, 1e-10);
      const MatrixXd q = sink.get("/hinges/joint/q");
      const auto poses = get_relative(sink, spec);
      double worst = 0;
      for (int i = 0; i < sink.num_samples(); ++i)
        worst = std::max(worst, joint.calc_residual(poses[static_cast<size_t>(i)], q.row(i).transpose()));
      EXPECT_LT(worst, 1e-13 * (10 + q.cwiseAbs().maxCoeff()));
      EXPECT_GT((q.colwise().maxCoeff() - q.colwise().minCoeff()).minCoeff(), 0.1);
      const VectorXd energy = (sink.get("/energy/kinetic") + sink.get("/energy/strain")).col(0);
      const double lost = energy[0] - energy[energy.size() - 1], heat = has_damper ? calc_heat(sink, "joint") : 0;
      EXPECT_NEAR(lost, heat, 1e-7 * energy[0]);
      EXPECT_NEAR(get_last(sink, "/energy/dissipated"), lost, 1e-9 * energy[0]);
    }
  }
}

TEST(HingesInMotion, AreTheSameAsConstraints) {
  for (const Joint& joint : make_joints()) {
    SCOPED_TRACE(joint.name);
    auto spec = make_pair(joint, false);
    spec.hinges[1].stiffness.clear();
    spec.hinges[1].null_position.clear();
    spec.simulation.duration = 0.5;
    const MemorySink tree = run_kept(spec, 1e-11);
    auto loop = spec;
    const auto& h = spec.hinges[1];
    loop.hinges[1] = make_hinge_record("joint", HingeType::Free, "ground", "child");
    const auto start = [&](const std::string& channel) {
      return VectorXd(tree.get("/bodies/child/" + channel).row(0));
    };
    for (const std::string channel : {"quaternion", "position"})
      for (const double x : start(channel)) loop.hinges[1].position.push_back(x);
    for (const std::string channel : {"angular_velocity", "velocity"})
      for (const double x : start(channel)) loop.hinges[1].rate.push_back(x);
    records::ConstraintRecord c;
    c.name = "joint";
    c.hinge = joint.type;
    c.parent = "base";
    c.child = "child";
    c.rotations = h.rotations;
    c.axis = h.axis;
    c.axis2 = h.axis2;
    c.pitch = h.pitch;
    c.parent_position = h.parent_position;
    c.child_position = h.child_position;
    c.parent_rotation = h.parent_rotation;
    c.child_rotation = h.child_rotation;
    loop.constraints = {c};
    const MemorySink sink = run_kept(loop, 1e-11);
    expect_momenta_hold(sink, 1e-10);
    double worst = 0, residual = 0;
    const MatrixXd q = tree.get("/hinges/joint/q");
    const auto in_tree = get_relative(tree, spec), in_loop = get_relative(sink, spec);
    for (size_t i = 0; i < in_tree.size(); ++i) {
      const Pose &a = in_tree[i], &b = in_loop[i];
      worst = std::max(worst, (a.R - b.R).norm() + (a.p - b.p).norm());
      residual = std::max(residual, joint.calc_residual(b, q.row(static_cast<Eigen::Index>(i)).transpose()));
    }
    EXPECT_LT(worst, 1e-9);
    EXPECT_LT(residual, 1e-9);  // with the coordinates of the tree's run
    for (const std::string which : {"reaction_force", "reaction_moment"})
      EXPECT_LT((tree.get("/hinges/joint/" + which) - sink.get("/constraints/joint/" + which)).cwiseAbs().maxCoeff(),
                1e-8)
          << which;
  }
}

// Two wheels geared across each other, and a slide that a pinion drives, on a free body.
TEST(HingesInMotion, GearsAndARackOnAFreeBody) {
  for (const bool is_rack : {false, true}) {
    SCOPED_TRACE(is_rack);
    Random random(5);
    records::SystemSpec spec;
    for (const std::string name : {"base", "first", "second"}) spec.bodies.push_back(make_rigid_record(name, random));
    spec.hinges = {make_hinge_record("root", HingeType::Free, "ground", "base"),
                   make_hinge_record("first", HingeType::Revolute, "base", "first"),
                   make_hinge_record("second", is_rack ? HingeType::Prismatic : HingeType::Revolute, "base", "second")};
    spec.hinges[0].rate = {0.3, -0.5, 0.4, 0.2, 0.1, -0.3};
    const double ratio = is_rack ? -4 : 2.5;
    for (const size_t i : {1u, 2u}) {
      auto& h = spec.hinges[i];
      h.axis = random.vector();
      h.parent_position = random.vector();
      h.child_position = random.vector();
      h.parent_rotation = random.rotation();
      h.child_rotation = random.rotation();
    }
    spec.hinges[1].position = {0.5};
    spec.hinges[1].rate = {1.5};
    spec.hinges[2].position = {-0.5 / ratio};
    spec.hinges[2].rate = {-1.5 / ratio};
    spec.hinges[1].damping = {kDamping};
    records::ConstraintRecord gear;
    gear.name = "gear";
    gear.type = records::ConstraintType::Coupler;
    gear.terms = {{"first", 1, 1}, {"second", 1, ratio}};
    spec.constraints = {gear};
    spec.simulation.duration = 2;
    spec.simulation.output_step = 0.01;
    spec.simulation.integrator = "rk";
    spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
    const MemorySink sink = run_kept(spec, 1e-11);
    expect_momenta_hold(sink, 1e-10);
    for (const std::string what : {"q", "qdot"})
      EXPECT_LT((sink.get("/hinges/first/" + what) + ratio * sink.get("/hinges/second/" + what)).cwiseAbs().maxCoeff(),
                1e-12)
          << what;
    EXPECT_GT(sink.get("/constraints/gear/force").cwiseAbs().maxCoeff(), 0.05);
    const VectorXd kinetic = sink.get("/energy/kinetic").col(0);
    EXPECT_NEAR(kinetic[0] - kinetic[kinetic.size() - 1], calc_heat(sink, "first"), 1e-7 * kinetic[0]);
  }
}

}  // namespace
}  // namespace bough::solver::testing
