#include "report/pole_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "report/axis.hpp"
#include "report/label.hpp"

namespace bough::report {

namespace {

using records::LinearModel;

constexpr double kDampings[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9};

/// "ζ 0.05".
std::string format_damping(double zeta) {
  std::string text = "\u03b6 " + std::to_string(zeta);
  text.erase(text.find_last_not_of('0') + 1);
  return text;
}

/// "ω 20", in the unit of the axes.
std::string format_size(double size) { return "\u03c9 " + fmt::format("{:g}", size); }

/// Points drawn at one place, where one mark hides the others.
void add_count(const Curve& curve, double x, double y, double radius, const std::string& what, Plot& plot) {
  int count = 0;
  for (Eigen::Index i = 0; i < curve.x.size(); ++i) count += std::hypot(curve.x[i] - x, curve.y[i] - y) <= radius;
  if (count > 1) plot.notes.push_back({x, y, std::to_string(count) + " " + what});
}

/// Upper and lower branch of one guide; the upper one carries the label.
void add_guide(const Eigen::VectorXd& x, const Eigen::VectorXd& y, const std::string& label, Plot& plot) {
  plot.guides.push_back({label, x, y});
  plot.guides.push_back({"", x, -y});
}

void add_z_grid(Plot& plot) {
  constexpr int kPoints = 181;
  Curve circle{"", Eigen::VectorXd(kPoints), Eigen::VectorXd(kPoints)};
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / (kPoints - 1);
    circle.x[i] = std::cos(angle);
    circle.y[i] = std::sin(angle);
  }
  plot.guides.push_back(circle);
  for (const double zeta : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    Eigen::VectorXd x(kPoints), y(kPoints);
    for (int i = 0; i < kPoints; ++i) {
      const double angle = std::numbers::pi * i / (kPoints - 1);
      const double radius = std::exp(-zeta * angle / std::sqrt(1 - zeta * zeta));
      x[i] = radius * std::cos(angle);
      y[i] = radius * std::sin(angle);
    }
    add_guide(x, y, format_damping(zeta), plot);
  }
}

/// A small frame of all guides in the picture: the unit circle belongs to the range.
void open_range(Plot& plot) {
  plot.curves.push_back({"", Eigen::Vector2d(-1, 1), Eigen::Vector2d(-1, 1), true, -1, Mark::None});
}

void add_s_poles(const std::string& prefix, const LinearModel& model, Plot& plot) {
  const auto poles = round_poles(model.poles);
  std::vector<Eigen::Index> shown;
  for (Eigen::Index i = 0; i < poles.real.size(); ++i)
    if (!records::is_gone(model, i)) shown.push_back(i);
  plot.curves.push_back({prefix + "poles", poles.real(shown), poles.imag(shown), true, -1, Mark::Cross});
}

/// Zeros far beyond the poles would shrink these to a point: they are counted in the legend.
void add_zeros(const std::string& prefix, const LinearModel& model, const Curve& poles, Plot& plot) {
  constexpr double kFar = 3;
  const Eigen::ArrayXd size = (model.zeros_real.array().square() + model.zeros_imag.array().square()).sqrt();
  const double largest =
      poles.x.size() > 0 ? std::sqrt((poles.x.array().square() + poles.y.array().square()).maxCoeff()) : 0;
  std::vector<Eigen::Index> shown;
  for (Eigen::Index i = 0; i < size.size(); ++i)
    if (largest == 0 || size[i] <= kFar * largest) shown.push_back(i);
  const auto num_far = size.size() - std::ssize(shown);
  const std::string label =
      prefix + "zeros" + (num_far > 0 ? " (" + std::to_string(num_far) + " beyond the picture)" : "");
  plot.curves.push_back({label, model.zeros_real(shown), model.zeros_imag(shown), true, -1, Mark::Ring});
}

void add_z_poles(const std::string& prefix, const LinearModel& model, Plot& plot) {
  const auto n = model.poles.real.size();
  Curve curve{prefix + "poles", Eigen::VectorXd(n), Eigen::VectorXd(n), true, -1, Mark::Cross};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto z = records::calc_z(model, i);
    curve.x[i] = z.real();
    curve.y[i] = z.imag();
  }
  plot.curves.push_back(std::move(curve));
}

}  // namespace

void add_s_grid(Plot& plot) {
  double left = 0, up = 0;
  for (const auto& curve : plot.curves) {
    if (curve.x.size() == 0) continue;
    left = std::max(left, -curve.x.minCoeff());
    up = std::max(up, curve.y.cwiseAbs().maxCoeff());
  }
  plot.has_zero_x = true;
  if (left <= 0 || up <= 0) return;
  double last = 0;
  for (const double zeta : kDampings) {
    // Angle from the vertical in the picture, whose axes have different scales.
    const double across = zeta * up / (std::sqrt(1 - zeta * zeta) * left);
    const double angle = std::atan(across);
    if (angle < last + 0.16 || angle > 1.45) continue;
    last = angle;
    const double far = 2 * (left + up);
    const Eigen::Vector2d x(0, -zeta * far), y(0, std::sqrt(1 - zeta * zeta) * far);
    add_guide(x, y, format_damping(zeta), plot);
  }
  constexpr int kPoints = 61;
  const auto axis = make_axis(0, up, 4, false);
  for (const double size : axis.ticks) {
    if (size <= 0) continue;
    Eigen::VectorXd x(kPoints), y(kPoints);
    for (int i = 0; i < kPoints; ++i) {
      const double angle = std::numbers::pi / 2 * i / (kPoints - 1);
      x[i] = -size * std::sin(angle);
      y[i] = size * std::cos(angle);
    }
    add_guide(x, y, format_size(size), plot);
  }
}

Eigen::VectorXd calc_pole_uncertainty(const records::Poles& poles, double min) {
  const Eigen::ArrayXd size = (poles.real.array().square() + poles.imag.array().square()).sqrt();
  const double largest = size.size() > 0 ? size.maxCoeff() : 0;
  if (poles.error.size() == size.size()) return poles.error.cwiseMax(1e-12 * largest);
  return Eigen::VectorXd::Constant(size.size(), min * largest);
}

records::Poles round_poles(const records::Poles& poles) {
  records::Poles rounded = poles;
  const Eigen::VectorXd uncertainty = calc_pole_uncertainty(poles, 1e-12);
  for (auto* part : {&rounded.real, &rounded.imag})
    *part = (part->array().abs() > uncertainty.array()).select(*part, 0);
  rounded.damping = (rounded.real.array() == 0).select(0, poles.damping);
  return rounded;
}

void make_z_plane(Plot& plot) {
  plot.x_label = "real part of z";
  plot.y_label = "imaginary part of z";
  plot.is_equal = true;
  add_z_grid(plot);
  open_range(plot);
}

Plot make_pole_plot(const std::vector<std::pair<std::string, const LinearModel*>>& models) {
  const bool is_z =
      std::all_of(models.begin(), models.end(), [](const auto& named) { return named.second->sample_time > 0; });
  std::string time = models.empty() ? "" : models.front().second->units.time;
  for (const auto& [name, model] : models)
    if (model->units.time != time) time.clear();
  const std::string unit = time.empty() ? "1/T" : "1/" + time;
  Plot plot{"", make_label("real part", unit), make_label("imaginary part", unit), {}};
  for (const auto& [name, model] : models) {
    const std::string prefix = name.empty() ? "" : name + " ";
    is_z ? add_z_poles(prefix, *model, plot) : add_s_poles(prefix, *model, plot);
    const Curve poles = plot.curves.back();
    if (!is_z && model->sample_time == 0 && model->zeros_real.size() > 0) add_zeros(prefix, *model, poles, plot);
    const double largest = poles.x.size() > 0 ? poles.x.cwiseAbs().maxCoeff() + poles.y.cwiseAbs().maxCoeff() : 0;
    if (is_z) {
      add_count(poles, 1, 0, 1e-6, "at 1", plot);
      add_count(poles, 0, 0, records::kGone, "at 0: gone within a sample", plot);
    } else {
      add_count(poles, 0, 0, 1e-9 * largest, "at 0", plot);
    }
  }
  is_z ? make_z_plane(plot) : add_s_grid(plot);
  return plot;
}

}  // namespace bough::report
