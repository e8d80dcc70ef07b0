// Event functions and their zero crossings: kinks of forces, switches of blocks, joint contacts (dry friction, rigid
// stops), signals of events. All are evaluated together, at every sample and at the end of every step, so that nothing
// that the samples show is missed, however long the steps are.
#include <algorithm>
#include <cmath>

#include "solver/integrate/locate.hpp"
#include "solver/simulate/run.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {
/// Round-off of a kink function, relative to its largest value so far: below it before and after, there is no crossing.
constexpr double kKinkNoise = 1e-12;
/// Round-off of a contact function, relative to its value after: a contact at its limit may be on either side of it.
constexpr double kContactNoise = 1e-9;
}  // namespace

void Run::start_events() {
  const System& system = ode_.system();
  int kinks = 0;
  // Fixed steps depend on the samples and stops alone. Error estimates of adaptive ones look at few moments of a step
  // (Dormand and Prince's 8(7) at its two ends only) and miss a contact between them: their steps end at kinks.
  if (setup_.integrator != "rk4" && setup_.integrator != "implicit")
    for (const auto& element : system.elements) kinks += element->num_kinks();
  events_.kinks = VectorXd::Zero(kinks);
  events_.switches = VectorXd::Zero(system.signals.num_event_functions);
  events_.contacts = joint_contacts_.make_guards();
  events_.signals = setup_.triggers.make_gaps();
  last_events_ = look_.events = events_;
  largest_kinks_ = look_.largest_kinks = events_.kinks;
  signs_ = look_.signs = setup_.triggers.signs;
}

bool Run::has_event_functions() const {
  return events_.kinks.size() > 0 || events_.switches.size() > 0 || !joint_contacts_.empty() ||
         setup_.triggers.has_signals();
}

void Run::calc_kinks(double t) {
  guard([&] {
    if (!is_evaluated(t)) {
      const int nq = ode_.num_q();
      calc_kinematics(ode_.system(), ode_.data(), t, y_.head(nq), y_.segment(nq, ode_.num_coordinates() - nq));
    }
    double* g = events_.kinks.data();
    for (const auto& element : ode_.system().elements) {
      element->calc_kinks(ode_.system().tree, ode_.data().tree, g);
      g += element->num_kinks();
    }
  });
}

void Run::restart_kinks(double t) {
  if (events_.kinks.size() == 0) return;
  calc_kinks(t);
  last_events_.kinks = events_.kinks;
  largest_kinks_ = largest_kinks_.cwiseMax(events_.kinks.cwiseAbs());
}

void Run::calc_switches(double t) {
  evaluate(t, true);
  guard([&] {
    ode_.system().signals.calc_event_functions(get_motion(ode_.system(), ode_.data()), ode_.data().signals,
                                               events_.switches);
  });
}

void Run::calc_contacts(double t) {
  evaluate(t, false);
  joint_contacts_.calc_event_functions(ode_.data(), events_.contacts);
}

void Run::calc_events(double t, const TimeEvent& stop) {
  guard([&] { integrator_->calc_state(t, y_); });
  has_located_ = false;
  const double time = std::min(t, stop.left);
  const bool has_switches = events_.switches.size() > 0, has_signals = setup_.triggers.has_signals();
  // One evaluation for all, and for the sample that is due.
  if (has_switches || has_signals || t == time_events_.next_output())
    evaluate(time, true);
  else if (!joint_contacts_.empty())
    evaluate(time, false);
  if (events_.kinks.size() > 0) calc_kinks(time);
  if (has_switches) calc_switches(time);
  if (!joint_contacts_.empty()) calc_contacts(time);
  calc_signal_events(time);
}

double Run::locate(VectorXd EventValues::*rows, Eigen::Index i, double before, double to, double tolerance,
                   const TimeEvent& stop) {
  const double after = (events_.*rows)[i];
  const auto calc = [&](double t) {
    guard([&] { integrator_->calc_state(t, y_); });
    const double time = std::min(t, stop.left);
    if (rows == &EventValues::kinks)
      calc_kinks(time);
    else if (rows == &EventValues::switches)
      calc_switches(time);
    else if (rows == &EventValues::contacts)
      calc_contacts(time);
    else
      calc_signal_events(time);
    return (events_.*rows)[i];
  };
  const VectorXd at_end = events_.*rows;
  const double at = locate_crossing(calc, scanned_, before, to, after, tolerance);
  events_.*rows = at_end;
  has_located_ = true;
  return at;
}

template <class Before>
bool Run::find_first(VectorXd EventValues::*rows, const Before& get_before, const TimeEvent& stop, double& to) {
  std::optional<double> first;
  for (Eigen::Index i = 0; i < (events_.*rows).size(); ++i) {
    if (const std::optional<double> before = get_before(i))
      first = std::min(first.value_or(to), locate(rows, i, *before, to, time_events_.resolution(), stop));
  }
  if (first && *first < to) calc_events(to = *first, stop);
  return first.has_value();
}

void Run::look_ahead(const TimeEvent& stop, double to) {
  calc_events(to, stop);
  Change found;
  found.time = to;
  look_.largest_kinks = largest_kinks_;
  look_.signs = setup_.triggers.signs;
  const auto kink = [&](Eigen::Index i) -> std::optional<double> {
    const double before = last_events_.kinks[i], after = events_.kinks[i];
    double& largest = look_.largest_kinks[i];
    largest = std::max(largest, std::abs(after));
    if (before * after >= 0) return {};
    if (std::max(std::abs(before), std::abs(after)) < kKinkNoise * largest) return {};
    return before;
  };
  const auto block = [&](Eigen::Index i) -> std::optional<double> {
    if (!(events_.switches[i] > 0)) return {};
    return std::min(0.0, last_events_.switches[i]);
  };
  const auto contact = [&](Eigen::Index i) -> std::optional<double> {
    if (!(events_.contacts[i] > 0)) return {};
    return std::min(last_events_.contacts[i], -kContactNoise * events_.contacts[i]);
  };
  found.is_kink = find_first(&EventValues::kinks, kink, stop, found.time);
  const bool switches = find_first(&EventValues::switches, block, stop, found.time);
  const bool changes = find_first(&EventValues::contacts, contact, stop, found.time);
  found.is_switch = switches || changes;
  found.firing = find_occurrence(stop, found.time);
  look_.change = found;
  look_.events = events_;
}

void Run::accept_look(double until) {
  const auto is_later = [&](const Crossing& c) { return c.log.time > until; };
  const auto later = std::find_if(look_.logs.begin(), look_.logs.end(), is_later);
  for (auto c = look_.logs.begin(); c != later; ++c) {
    setup_.triggers.signs[static_cast<Eigen::Index>(c->log.trigger)] = c->sign;  // the record says which way
    write_event(c->log);
  }
  look_.logs.erase(look_.logs.begin(), later);
}

void Run::refresh_events(double t) {
  if (events_.switches.size() > 0) calc_switches(t);
  if (!joint_contacts_.empty()) calc_contacts(t);
  calc_signal_events(t);
  for (VectorXd EventValues::*rows : {&EventValues::switches, &EventValues::contacts, &EventValues::signals})
    last_events_.*rows = events_.*rows;
  scanned_ = t;
}

std::optional<Run::Change> Run::scan_step(const TimeEvent& stop, double t_pause) {
  for (;;) {
    const double sample = time_events_.next_output(), end = integrator_->time(), to = std::min(sample, end);
    const bool looks = has_event_functions();
    if (looks && !has_look_) look_ahead(stop, to);
    has_look_ = looks;
    Change found;
    found.time = to;
    if (looks) found = look_.change;
    const double stands = found.firing ? found.firing->time : found.time;
    // A pause that differs from the next event time by round-off is a pause at that time.
    if (t_pause < stands - time_events_.resolution()) {
      accept_look(t_pause);
      has_located_ = true;
      Change pause;
      pause.time = t_pause;
      pause.is_pause = true;
      return pause;
    }
    if (looks) {
      accept_look(stands);
      last_events_ = look_.events;
      largest_kinks_ = look_.largest_kinks;
      setup_.triggers.signs = look_.signs;
    }
    has_look_ = false;
    scanned_ = stands;
    if (sample <= stands && !write_output(sample, looks && !has_located_)) return {};
    if (found.is_kink || found.is_switch || found.firing || stands >= end) return found;
  }
}

}  // namespace bough::solver
