// A run whose continuous states an integrator of the host moves: derivatives, event functions, event mode.
#include <algorithm>
#include <cmath>

#include "solver/simulate/run.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {
/// Position error of constraints, and error of the norm of quaternions, from which a step of the host is corrected.
constexpr double kDrift = 1e-9;
}  // namespace

double Run::calc_seen_time() const { return is_at_event_ ? time_ : std::min(time_, next_event_.left); }

void Run::find_next_stop() {
  const double end = time_events_.end();
  next_event_ = time_ < end ? time_events_.find_next(time_) : TimeEvent{end, end, true};
}

double Run::next_event_time() {
  if (!std::isfinite(next_event_.time)) find_next_stop();
  return next_event_.time;
}

void Run::lead() {
  next_event_time();
  is_led_ = true;
  needs_restart_ = true;
  is_inside_ = false;
}

void Run::set_continuous(double t, const Eigen::Ref<const VectorXd>& x) {
  lead();
  is_at_event_ = is_at_event_ && t == time_;
  time_ = t;
  y_ = x;
}

void Run::take_over() {
  if (!is_at_event_) update_discrete();
  is_led_ = false;
  next_event_ = kNoEvent;
  needs_restart_ = true;
  time_events_.skip_outputs(time_);
  last_sample_ = std::min(last_sample_, time_);
  if (!outcome_) restart_balance();
}

void Run::restart_balance() {
  evaluate(calc_seen_time(), false);
  Energies energies = calc_energies(ode_.system(), ode_.data());
  energies.strain -= ode_.get_work(y_);
  monitor_.start(energies, calc_noise());
}

void Run::calc_derivatives(Eigen::Ref<VectorXd> x_dot) {
  evaluate(calc_seen_time(), false);
  x_dot = y_dot_;
}

const VectorXd& Run::calc_continuous_outputs() { return calc_sample(calc_seen_time()); }

int Run::num_kinks() const {
  int kinks = 0;
  for (const auto& element : ode_.system().elements) kinks += element->num_kinks();
  return kinks;
}

int Run::num_event_functions() const {
  const auto others = events_.switches.size() + events_.contacts.size() + setup_.triggers.make_gaps().size();
  return num_kinks() + static_cast<int>(others);
}

void Run::calc_event_functions(Eigen::Ref<VectorXd> g) {
  const double t = calc_seen_time();
  evaluate(t, true);
  double* at = g.data();
  guard([&] {
    for (const auto& element : ode_.system().elements) {
      element->calc_kinks(ode_.system().tree, ode_.data().tree, at);
      at += element->num_kinks();
    }
  });
  if (events_.switches.size() > 0) calc_switches(t);
  if (!joint_contacts_.empty()) calc_contacts(t);
  calc_signal_events(t);
  for (const VectorXd* values : {&events_.switches, &events_.contacts, &events_.signals})
    at = std::copy_n(values->data(), values->size(), at);
}

std::vector<std::string> Run::list_event_functions() const {
  std::vector<std::string> names;
  const auto add = [&](const std::string& what, int count) {
    for (int i = 1; i <= count; ++i) names.push_back(what + (count > 1 ? " " + std::to_string(i) : ""));
  };
  for (const auto& element : ode_.system().elements) add("force '" + element->name() + "': kink", element->num_kinks());
  for (const auto& place : ode_.system().signals.places)
    add(place.block->label + ": switch", place.block->sizes.event_functions);
  add("joint contact", static_cast<int>(events_.contacts.size()));
  for (int i = 0; i < setup_.triggers.make_gaps().size(); ++i)
    names.push_back("event '" + setup_.triggers.get(static_cast<size_t>(i)).name + "'");
  return names;
}

bool Run::needs_projection() {
  if (!ode_.has_projection()) return false;
  evaluate(calc_seen_time(), false);
  return calc_largest_position_error(ode_.system().loops, ode_.data().loops) > kDrift;
}

bool Run::settle_jump() {
  iterate_switches(time_);
  if (setup_.triggers.has_signals()) {
    std::vector<Occurrence> firings;
    for (const size_t i : find_crossed(time_)) firings.push_back({time_, i});
    if (const auto ends = fire(std::move(firings))) {
      outcome_ = finish(*ends);
      return false;
    }
    if (has_changed_) iterate_switches(time_);
  }
  iterate_contacts(time_);
  return true;
}

bool Run::update_discrete() {
  next_event_time();
  const VectorXd before = y_;
  const bool at_stop = !is_at_event_ && std::abs(time_ - next_event_.time) <= time_events_.resolution();
  is_at_event_ = true;
  if (needs_projection()) guard([&] { ode_.project(time_, y_); });
  restart_balance();
  has_changed_ = has_switched_ = false;
  if (at_stop) {
    stop_ = next_event_;
    cross_jump();
    take_samples(time_);
    if (const auto ends = pass(stop_)) {
      outcome_ = finish(*ends);
      return true;
    }
  }
  if (!settle_jump()) return true;
  find_next_stop();
  if (time_ >= time_events_.end()) {
    save(time_events_.end());
    outcome_ = close(time_events_.end(), "");
  }
  return y_ != before;
}

}  // namespace bough::solver
