#include "solver/simulate/run.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "solver/simulate/channel_units.hpp"
#include "solver/system/system.hpp"
#include "solver/tree/gimbal_lock.hpp"

namespace bough::solver {
namespace {

/// Samples between checkpoints.
constexpr int kCheckpointEvery = 100;
/// Energy balance error, relative to energy_error_limit, at which a warning is issued.
constexpr double kEnergyWarning = 1e-2;
/// Position error, relative, of a constraint that projections do not close.
constexpr double kOpen = 1e-6;
/// Steps shorter than this, relative to the run, are counted; kMaxShortSteps in a row end the run.
constexpr double kShortStep = 3e-8;
constexpr int kMaxShortSteps = 20000;
/// Short steps between two reports of the progress.
constexpr int kLookUp = 500;
/// Sine of the angle between two axes of a gimbal below which a warning is issued.
constexpr double kNearLock = 0.01;
/// Amplitude, in absolute tolerances, of motions whose energy is noise.
constexpr double kNoise = 100;
/// Share of a body's mass used by its jets above which a warning reports that the mass is constant.
constexpr double kMaxPropellantShare = 0.01;
/// Share of the mass of a slosh pendulum within which its tank counts as drained.
constexpr double kDrained = 1e-9;

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

/// Upper bound of the samples written: the chosen ones within the window, the end, and where an event ends the run.
long calc_max_samples(const records::SimulationRecord& s, const RunPlan& plan, long num_outputs) {
  const double first = std::max(plan.start, s.output_from), last = std::min(plan.end, s.output_until);
  const double window = std::max(0.0, last - first) / plan.output_step / s.output_every;
  const double all = std::ceil(static_cast<double>(num_outputs - 1) / s.output_every) + 1;
  return static_cast<long>(std::min(all, std::floor(window + 1e-6) + 3));
}

records::ResultsHeader make_header(const System& system, const records::SystemSpec& spec, const RunSetup& setup,
                                   long num_outputs) {
  const auto& s = spec.simulation;
  records::ResultsHeader header;
  header.system_text = spec.text;
  header.channels = setup.recorder.chosen_channels();
  label_channels(system, spec, header.channels);
  header.max_samples = calc_max_samples(s, setup.plan, num_outputs);
  header.settings = {{"integrator", setup.integrator},
                     {"start", text_of(s.start)},
                     {"duration", text_of(s.duration)},
                     {"output_step", text_of(setup.plan.output_step)},
                     {"output_every", std::to_string(s.output_every)},
                     {"step", text_of(setup.plan.step)},
                     {"rk_order", std::to_string(s.rk_order)},
                     {"relative_tolerance", text_of(s.relative_tolerance)},
                     {"absolute_tolerance", text_of(s.absolute_tolerance)},
                     {"divergence_limit", text_of(s.divergence_limit)},
                     {"energy_error_limit", text_of(s.energy_error_limit)},
                     {"gravity", text_of(s.gravity.x()) + " " + text_of(s.gravity.y()) + " " + text_of(s.gravity.z())}};
  return header;
}

StepperOptions make_stepper_options(const HybridSystem& ode, const records::SimulationRecord& s, const RunPlan& plan) {
  StepperOptions o;
  o.relative_tolerance = s.relative_tolerance;
  o.absolute_tolerance = VectorXd::Constant(ode.size(), s.absolute_tolerance);
  if (s.absolute_tolerance_modes > 0) {
    const System& system = ode.system();
    for (int b = 0; b < system.num_bodies(); ++b) {
      const int n = system.num_modes(b);
      o.absolute_tolerance.segment(system.eta_offset(b), n).setConstant(s.absolute_tolerance_modes);
      o.absolute_tolerance.segment(ode.num_q() + system.eta_dot_offset(b), n).setConstant(s.absolute_tolerance_modes);
    }
  }
  // Work is a quadrature that follows the accuracy of the motion. Its loose tolerance sets the step only if the motion
  // does not.
  o.absolute_tolerance.tail(ode.size() - ode.num_coordinates() - ode.num_z())
      .setConstant(std::sqrt(s.absolute_tolerance));
  o.step = plan.step;
  // Steps are no longer than the output interval, so that they miss no event of a function of time that a sample shows.
  const auto& places = ode.system().signals.places;
  if (o.step == 0 &&
      std::any_of(places.begin(), places.end(), [](const auto& p) { return p.block->depends_on_time(); }))
    o.step = plan.output_step;
  o.rk_order = s.rk_order;
  return o;
}

TimeEvents make_timeline(const System& system, const RunSetup& setup) {
  auto jumps = setup.triggers.collect_times(false);
  auto mesh_times = setup.triggers.collect_times(true);
  jumps.insert(jumps.end(), system.jump_times.begin(), system.jump_times.end());
  mesh_times.insert(mesh_times.end(), system.mesh_times.begin(), system.mesh_times.end());
  TimeEvents timeline(setup.plan, std::move(jumps), std::move(mesh_times));
  for (const auto& s : system.signals.collect_samples()) timeline.add_samples(s.first, s.period);
  return timeline;
}

}  // namespace

Run::Run(const System& system, const records::SystemSpec& spec, RunSetup setup, records::ResultSink& sink,
         const SimulateOptions& options, Diagnostics& diagnostics)
    : spec_(spec),
      sink_(sink),
      options_(options),
      diagnostics_(diagnostics),
      setup_(std::move(setup)),
      time_events_(make_timeline(system, setup_)),
      ode_(system),
      expected_data_(system.make_data()),
      limit_(system),
      modal_limit_(limit_.calc_modal_limit()),
      joint_contacts_(system) {
  integrator_ = make_integrator(setup_.integrator, ode_, make_stepper_options(ode_, spec.simulation, setup_.plan));
  y_ = y_dot_ = coming_y_dot_ = VectorXd::Zero(ode_.size());
  checkpoint_.state = y_;
  checkpoint_.memory = {{"energy", VectorXd::Zero(EnergyMonitor::kMemory)},
                        {"quaternions", setup_.recorder.quaternions},
                        {"limits", VectorXd::Zero(2 * limit_.num_watched())},
                        {"events", VectorXd::Zero(1 + setup_.triggers.signs.size())},
                        {"stepper", VectorXd::Zero(4)},
                        {"discrete", ode_.make_memory()},
                        {"control", VectorXd::Zero(1 + ode_.data().signals.memory.size())},
                        {"latches", joint_contacts_.make_memory()}};
  evaluated_.y = y_;
  evaluated_.memory = ode_.data().signals.memory;
  evaluated_.slide = ode_.data().tree.slide;
  chosen_.resize(system.signals.places.size());
  start_events();
  for (int b = 0; b < system.num_bodies(); ++b) {
    const TreeBody& tb = system.tree[b];
    if (tb.hinge->has_independent_coordinates() && tb.num_hinge_u() > 2) gimbals_.push_back(b);
  }
  inside_.resize(system.elements.size());
  std::iota(inside_.begin(), inside_.end(), size_t{0});
  progress_.start = time_events_.start();
  progress_.end = time_events_.end();
}

void Run::set_variant() {
  const System& system = ode_.system();
  setup_.recorder.set_system(system);
  limit_.set_system(system);
  joint_contacts_.set_system(system);
  expected_data_ = system.make_data();
  evaluated_.number = evaluated_.motion_number = -1;
}

void Run::start() {
  begin();
  if (outcome_ || time_ >= time_events_.end()) return;
  enter_interval();
  take_step(stop_);
}

void Run::enter_interval() {
  stop_ = time_events_.find_next(time_);
  if (needs_restart_) {
    if (scanned_ < time_) refresh_events(time_);
    reset(time_);
    if (const auto* memory = restored_.find("stepper")) integrator_->set_memory(*memory);
    restored_ = {};
  } else {
    integrator_->set_stop(stop_.time, stop_.left);
  }
  has_changed_ = has_switched_ = has_stepped_ = false;
  is_inside_ = true;
}

Run::Arrival Run::cross_interval(double t_pause) {
  for (;;) {
    if (scanned_ >= integrator_->time()) {
      if (integrator_->time() >= stop_.time) return Arrival::AtStop;
      if (has_stepped_ && is_stop_asked()) {
        y_ = integrator_->state();
        outcome_ = halt(time_ = integrator_->time());
        return Arrival::End;
      }
      if (has_stepped_) save_now_and_then();
      take_step(stop_);
      has_stepped_ = true;
    }
    const auto change = scan_step(stop_, t_pause);
    if (!change) return Arrival::End;
    if (change->is_pause) {
      guard([&] { integrator_->calc_state(time_ = t_pause, y_); });
      return Arrival::Pause;
    }
    const bool is_early = change->firing && change->firing->time < stop_.time;
    if (is_early || (change->is_switch && change->time < stop_.time)) {
      // An event, or a switch of a block or a contact, ends the step.
      time_ = is_early ? change->firing->time : change->time;
      guard([&] { integrator_->calc_state(time_, y_); });
      if (is_early) {
        if (const auto ends = fire({*change->firing})) {
          outcome_ = finish(*ends);
          return Arrival::End;
        }
      }
      iterate_switches(time_);
      iterate_contacts(time_);
      return Arrival::Cut;
    }
    if (change->firing) waiting_.push_back(*change->firing);
    if (change->is_kink && change->time < integrator_->time()) {  // the rest of the step is void
      guard([&] { integrator_->calc_state(change->time, y_); });
      reset(change->time);
    }
    // Not where the stop itself is due at the pause: the integrator may end a step short of it by round-off.
    const double reached = scanned_, slack = time_events_.resolution();
    if (reached < stop_.time && reached >= t_pause - slack && stop_.time > t_pause + slack) {
      guard([&] { integrator_->calc_state(time_ = reached, y_); });
      return Arrival::Pause;
    }
  }
}

void Run::arrive_at_stop() {
  integrator_->calc_state(time_ = stop_.time, y_);
  cross_jump();
  take_samples(time_);
  if (const auto ends = pass(stop_)) {
    outcome_ = finish(*ends);
    return;
  }
  if (has_changed_) iterate_switches(time_);
  iterate_contacts(time_);
  if (is_stop_asked() && time_ < time_events_.end()) {
    outcome_ = halt(time_);
    return;
  }
  needs_restart_ = stop_.is_jump || has_changed_ || has_switched_;
  is_inside_ = false;
}

void Run::advance_to(double t) {
  if (is_led_) take_over();
  const double until = std::min(t, time_events_.end());
  const double slack = until < time_events_.end() ? time_events_.resolution() : 0;
  bool has_due = false;  // a stop at `until`, after a cut that lies there too
  while (!outcome_ && (time_ < until - slack || has_due)) {
    has_due = false;
    if (!is_inside_) enter_interval();
    const Arrival arrival = cross_interval(until);
    if (arrival == Arrival::Cut) {
      needs_restart_ = true;
      is_inside_ = false;
      settle_cut(time_);
      has_due = time_ < until && time_events_.find_next(time_).time <= until + slack;
    } else if (arrival == Arrival::AtStop) {
      arrive_at_stop();
    }
  }
  is_at_event_ = true;
  next_event_ = kNoEvent;
  if (outcome_ || time_ < time_events_.end()) return;
  save(time_events_.end());
  outcome_ = close(time_events_.end(), "");
}

void Run::reset(double t) {
  restart_kinks(t);
  integrator_->reset(t, y_, stop_.time, stop_.left);
  is_started_ = true;
  scanned_ = t;
  has_look_ = false;
}

void Run::settle_cut(double t) {
  const double span = time_events_.end() - time_events_.start(), taken = t - last_event_time_;
  num_short_steps_ = taken < kShortStep * span ? num_short_steps_ + 1 : 0;
  last_event_time_ = t;
  if (num_short_steps_ > kMaxShortSteps)
    finish_failed(t, "run.stalled",
                  "the run makes no progress at t = " + short_text(t) + ": " + std::to_string(kMaxShortSteps) +
                      " switches, impacts or events in a row came within " + short_text(kShortStep * span) +
                      " of each other",
                  "give switches a hysteresis, stops room or a stiffness, events values that lie apart");
  if (num_short_steps_ > 0 && num_short_steps_ % kLookUp == 0 && options_.progress) {
    update_progress(t);
    options_.progress(progress_);
  }
  if (is_stop_asked() && t < time_events_.end()) {
    outcome_ = halt(t);
    return;
  }
  if (std::chrono::steady_clock::now() - saved_at_ >= options_.checkpoint_after) save(t);
}

void Run::begin() {
  y_ = ode_.make_initial_state();
  time_ = time_events_.start();
  const double t = time_;
  if (options_.resume) check_resume();
  sink_.begin(make_header(ode_.system(), spec_, setup_, time_events_.num_outputs()));
  // "start": what controllers start from, of a state that was found; the run begins there as any.
  const bool goes_on = options_.resume && !options_.resume->find("start");
  if (options_.resume && !goes_on) {
    y_ = options_.resume->state;
    if (const auto* m = options_.resume->find("control")) set_control_memory(*m);
  }
  evaluate(t, false);
  monitor_.start(calc_energies(ode_.system(), ode_.data()), calc_noise());
  saved_at_ = std::chrono::steady_clock::now();
  if (goes_on) {
    time_ = restore(*options_.resume);
    if (!options_.resume->find("energy")) {  // of a state that no run has led to
      evaluate(time_, false);
      monitor_.start(calc_energies(ode_.system(), ode_.data()), calc_noise());
    }
    resume_at_stop(time_);
    return;
  }
  initialize_lags(t);
  take_samples(t);
  initialize_lags(t);  // those that follow samples
  iterate_contacts(t);
  checkpoint_.time = t;
  write_outputs_at(t);
  start_signal_events(t);
  passed_ = t;
  fire_due(t);
}

void Run::resume_at_stop(double t) {
  const auto stop = time_events_.find_at(t);
  if (!stop || t <= time_events_.start() || std::abs(passed_ - t) <= time_events_.resolution()) return;
  stop_ = *stop;
  if (const auto ends = pass(stop_)) outcome_ = finish(*ends);
}

void Run::fire_due(double t) {
  std::vector<Occurrence> due;
  setup_.triggers.find_due(t, time_events_.resolution(), due);
  if (const auto ends = fire(std::move(due))) outcome_ = finish(*ends);
}

double Run::calc_noise() {
  const double small = kNoise * spec_.simulation.absolute_tolerance;
  const System& system = ode_.system();
  const VectorXd q = y_.head(ode_.num_q()), u = VectorXd::Constant(system.num_u(), small);
  auto data = system.make_data();
  calc_kinematics(system, *data, time_events_.start(), q, u);
  double noise =
      calc_energies(system, *data).kinetic - system.signals.calc_energy(get_motion(system, *data), data->signals);
  for (const TreeBody& tb : system.tree.bodies) noise += 0.5 * small * small * tb.body.K().trace();
  return noise;
}

double Run::calc_flow() const {
  const TreeData& data = ode_.data().tree;
  double force = 0, moment = 0, size = 0;
  for (int b = 0; b < ode_.system().tree.size(); ++b) {
    const BodyInertia& body = data[b].inertia;
    const auto applied = data.applied.segment<6>(ode_.system().tree[b].v_offset);
    force += body.mass * ode_.system().gravity.uniform.norm() + applied.head<3>().norm();
    moment += applied.tail<3>().norm();
    size = std::max(size, data[b].state.p_WBo.norm() + (body.mass > 0 ? body.S.norm() / body.mass : 0));
  }
  // Springs, dampers and actuators of hinges: a force along the size, or a moment through one radian.
  double along = 0;
  for (int row = 0; row < ode_.system().tree.num_u; ++row) along += std::abs(data.get_hinge_force(row));
  return force * size + moment + along * std::max(size, 1.0);
}

void Run::cross_jump() {
  if (!stop_.is_jump || stop_.left >= stop_.time) return;  // at the end there may be no jump
  expected_at_ = -std::numeric_limits<double>::infinity();
  guard([&] {
    const auto jumps = ode_.cross_jump(stop_.left, stop_.time, y_);
    if (crossed_ == stop_.time) return;
    for (const auto& what : jumps) sink_.write_event({stop_.time, what});
    crossed_ = stop_.time;
  });
}

void Run::set_work_tolerance() {
  const double root = std::sqrt(spec_.simulation.absolute_tolerance);
  const int first = ode_.num_coordinates() + ode_.num_z();
  // From rest the energies are yet to come.
  const double size = monitor_.size() > root ? monitor_.size() : std::max(monitor_.size(), calc_coming_energy());
  integrator_->set_last_tolerances(ode_.size() - first, root * std::clamp(size, root, 1.0));
}

double Run::calc_coming_energy() {
  const double t = integrator_->time();
  if (std::abs(t - expected_at_) < 0.1 * spec_.simulation.output_step) return expected_energy_;
  expected_at_ = t;
  const System& system = ode_.system();
  VectorXd& y_dot = coming_y_dot_;
  guard([&] { ode_.calc_derivative(t, integrator_->state(), y_dot); });
  auto u = y_dot.segment(ode_.num_q(), system.num_u());
  u *= spec_.simulation.output_step;
  calc_kinematics(system, *expected_data_, t, integrator_->state().head(ode_.num_q()), u);
  return expected_energy_ = calc_energies(system, *expected_data_).kinetic -
                            system.signals.calc_energy(get_motion(system, *expected_data_), expected_data_->signals);
}

void Run::take_step(const TimeEvent& stop) {
  const double before = integrator_->time();
  set_work_tolerance();
  guard([&] { integrator_->step(std::min(stop.time, time_events_.next_output())); });
  const auto y = integrator_->state();
  if (!y.allFinite()) fail_non_finite(integrator_->time(), integrator_->time());
  for (int row = 0; row < modal_limit_.size(); ++row) {
    if (std::abs(y[row]) > spec_.simulation.divergence_limit * modal_limit_[row])
      fail_diverged(integrator_->time(), ode_.name_row(row) + " reached " + short_text(y[row]) + ", " +
                                             short_text(std::abs(y[row]) / modal_limit_[row]) +
                                             " times what deflects the body by its own size");
  }
  watch_axes(integrator_->time());
  watch_elements(integrator_->time());
  const double taken = integrator_->time() - before;
  num_tiny_ = taken < 1e-11 * (progress_.end - progress_.start) ? num_tiny_ + 1 : 0;
  if (num_tiny_ > 1000) fail_stalled(before, "1000 steps in a row were shorter than " + short_text(taken));
}

void Run::watch_elements(double t) {
  const System& system = ode_.system();
  for (size_t i = 0; i < inside_.size(); ++i) {
    const auto& element = system.elements[inside_[i]];
    const ValidityWarning outside = element->check_validity(system.tree, ode_.data().tree);
    if (outside.id == nullptr) continue;
    const auto is_own = [&](const records::ForceElementRecord& record) { return record.name == element->name(); };
    const auto record = std::find_if(spec_.force_elements.begin(), spec_.force_elements.end(), is_own);
    inside_.erase(inside_.begin() + static_cast<std::ptrdiff_t>(i--));
    sink_.write_event({t, outside.message});
    diagnostics_.warning(outside.id, record != spec_.force_elements.end() ? record->at : spec_.simulation.at,
                         outside.message + ", from t = " + short_text(t) + " on", outside.advice);
  }
}

void Run::watch_axes(double t) {
  const Tree& tree = ode_.system().tree;
  for (size_t i = 0; i < gimbals_.size(); ++i) {
    const int b = gimbals_[i];
    if (find_nearest_axes(tree[b], ode_.data().tree[b]).sine > kNearLock) continue;
    const std::string what = describe_gimbal_lock(tree[b], ode_.data().tree[b], kNearLock) + " at t = " + short_text(t);
    gimbals_.erase(gimbals_.begin() + static_cast<std::ptrdiff_t>(i--));
    sink_.write_event({t, what, "hinge " + ode_.system().hinge_name(b)});
    diagnostics_.warning("run.gimbal-lock", tree[b].hinge_at, what, kGimbalAdvice);
  }
}

bool Run::write_output(double t, bool is_at_state) {
  if (!is_at_state) guard([&] { integrator_->calc_state(t, y_); });
  if (t == stop_.time) {
    cross_jump();
    take_samples(t);
  }
  const bool saves = time_events_.next_index() % kCheckpointEvery == 0;
  write_outputs_at(t);
  if (saves) save(t);
  if (!is_stop_asked() || t >= stop_.time) return true;  // events at the stop time are handled before the halt
  outcome_ = halt(t);
  return false;
}

void Run::write_outputs_at(double t) {
  const bool is_chosen = time_events_.next_index() % spec_.simulation.output_every == 0 || t == time_events_.end();
  const double slack = 1e-9 * setup_.plan.output_step;
  const bool is_inside = t >= spec_.simulation.output_from - slack && t <= spec_.simulation.output_until + slack;
  time_events_.take_output();
  observe(t);
  const VectorXd& sample = setup_.recorder.keep_sample();
  if (is_chosen && is_inside) sink_.write_sample(sample);
  last_sample_ = t;
  if (options_.progress) options_.progress(progress_);
}

void Run::observe(double t) {
  calc_sample(t);
  const Energies& e = setup_.recorder.energies();
  const double work = ode_.get_work(y_), dissipated = ode_.get_dissipated(y_);
  if (!std::isfinite(e.kinetic + e.strain + e.potential + work))
    fail_diverged(t, name_fastest() + ", and the energy is no finite number any more");
  const Loops& loops = ode_.system().loops;
  int open = -1;
  if (const double gap = calc_largest_position_error(loops, ode_.data().loops, &open); gap > kOpen)
    finish_failed(t, "run.open-constraint",
                  "constraint '" + loops[open].name + "' is open by " + short_text(gap) + " at t = " + short_text(t),
                  "look whether driven or locked hinges leave it no way to close, or drive against each other");
  monitor_.add(t, e, work, calc_flow());
  monitor_.add_energy_input(e, work, dissipated);
  // Energy that a jump of a prescribed motion adds is no divergence.
  if (time_events_.is_restart(t)) monitor_.add_energy_input(e.kinetic);
  for (const auto& crossing : limit_.find_crossings(t, ode_.data(), y_.head(ode_.num_q()))) {
    sink_.write_event({t, crossing.what});
    const bool is_known = crossing.id == ModalRangeMonitor::spin_id && setup_.spins_reported.count(crossing.body) > 0;
    if (!is_known) diagnostics_.warning(crossing.id, spec_.simulation.at, crossing.what, crossing.advice);
  }
  update_progress(t);
  const double limit = spec_.simulation.divergence_limit;
  if (e.kinetic > limit * limit * monitor_.energy_input() && monitor_.energy_input() > 0) {
    fail_diverged(t, name_fastest() + ", and the kinetic energy " + short_text(e.kinetic) + " where " +
                         short_text(monitor_.energy_input()) + " was put in");
  }
}

std::string Run::name_fastest() const {
  int row = 0;
  y_.segment(ode_.num_q(), ode_.num_coordinates() - ode_.num_q()).cwiseAbs().maxCoeff(&row);
  row += ode_.num_q();
  return ode_.name_row(row) + " reached " + short_text(y_[row]);
}

bool Run::is_evaluated(double t) const {
  const SystemData& data = std::as_const(ode_).data();
  return evaluated_.number == ode_.num_evaluations() && evaluated_.t == t && data.tree.has(Stage::Acceleration) &&
         evaluated_.y == y_ && evaluated_.memory == data.signals.memory && evaluated_.slide == data.tree.slide;
}

void Run::evaluate(double t, bool with_signals) {
  guard([&] {
    if (!is_evaluated(t)) {
      evaluated_.number = -1;
      ode_.calc_derivative(t, y_, y_dot_);
      evaluated_.number = ode_.num_evaluations();
      evaluated_.t = t;
      evaluated_.y = y_;
      evaluated_.memory = ode_.data().signals.memory;
      evaluated_.slide = ode_.data().tree.slide;
      evaluated_.has_signals = evaluated_.has_sample = false;
    }
    if (with_signals && !evaluated_.has_signals) calc_signals(ode_.system(), ode_.data());
    evaluated_.has_signals = evaluated_.has_signals || with_signals;
  });
}

SampleState Run::get_sample_state(double t) const {
  const int num_q = ode_.num_q();
  return {t,
          ode_.data(),
          y_.head(num_q),
          y_.segment(num_q, ode_.num_coordinates() - num_q),
          ode_.get_work(y_),
          ode_.get_dissipated(y_)};
}

const VectorXd& Run::calc_sample(double t) {
  evaluate(t, true);
  if (!evaluated_.has_sample) setup_.recorder.calc_sample(get_sample_state(t));
  evaluated_.has_sample = true;
  return setup_.recorder.sample();
}

bool Run::has_motion(double t) const {
  const SystemData& data = ode_.data();
  return evaluated_.motion_number == ode_.num_evaluations() && evaluated_.t == t && data.tree.has(Stage::Velocity) &&
         evaluated_.y == y_ && evaluated_.memory == data.signals.memory;
}

void Run::calc_motion(double t) {
  if (has_motion(t)) return;
  SystemData& data = ode_.data();
  evaluated_.number = evaluated_.motion_number = -1;
  set_z(data, y_.segment(ode_.num_coordinates(), ode_.num_z()));
  calc_kinematics(ode_.system(), data, t, y_.head(ode_.num_q()),
                  y_.segment(ode_.num_q(), ode_.num_coordinates() - ode_.num_q()));
  evaluated_.motion_number = ode_.num_evaluations();
  evaluated_.t = t;
  evaluated_.y = y_;
  evaluated_.memory = data.signals.memory;
  evaluated_.has_signals = evaluated_.has_sample = false;
}

const VectorXd& Run::calc_rows(double t, std::span<const int> rows) {
  const Outputs& outputs = setup_.recorder;
  if (is_evaluated(t) && evaluated_.has_sample) return outputs.sample();
  const bool is_of_motion = std::all_of(rows.begin(), rows.end(), [&](int row) { return outputs.is_of_motion(row); });
  bool has_signal = false;
  for (const int row : rows) has_signal = has_signal || outputs.get_place(row) >= 0;
  if (!is_of_motion) {
    evaluate(t, has_signal);
    return setup_.recorder.calc_rows(rows, get_sample_state(t));
  }
  guard([&] {
    const bool is_whole = is_evaluated(t);
    if (!is_whole) calc_motion(t);
    if (!has_signal || (is_whole && evaluated_.has_signals)) return;
    std::fill(chosen_.begin(), chosen_.end(), false);
    for (const int row : rows)
      if (const int place = outputs.get_place(row); place >= 0) chosen_[static_cast<size_t>(place)] = true;
    ode_.system().signals.calc_some(get_motion(ode_.system(), ode_.data()), ode_.data().signals, chosen_);
  });
  return setup_.recorder.calc_rows(rows, get_sample_state(t));
}

void Run::start_signal_events(double t) {
  calc_signal_events(t);
  last_events_.signals = events_.signals;
  setup_.triggers.start(events_.signals);
}

void Run::update_progress(double t) {
  const StepStatistics s = integrator_->statistics();
  progress_.time = t;
  progress_.step = s.step;
  progress_.order = s.order;
  progress_.num_steps = s.num_steps;
  progress_.num_rejected = s.num_rejected;
  progress_.num_evaluations = ode_.num_evaluations();
  progress_.energy_error = monitor_.latest();
}

void Run::tell_consumption() {
  const System& system = ode_.system();
  set_z(ode_.data(), y_.segment(ode_.num_coordinates(), ode_.num_z()));
  const VectorXd used = system.signals.calc_consumption(get_motion(system, ode_.data()), ode_.data().signals);
  for (int b = 0; b < system.num_bodies(); ++b) {
    const double mass = ode_.data().tree[b].inertia.mass;
    if (used[b] > kMaxPropellantShare * mass)
      diagnostics_.warning("run.propellant", spec_.simulation.at,
                           "the jets of body '" + system.body_name(b) + "' have used " + short_text(used[b]) +
                               " of propellant, " + short_text(100 * used[b] / mass) + " % of its mass " +
                               short_text(mass) + ", which stays as it is: its last accelerations are too small",
                           "give them a tank, whose mass leaves the body");
  }
}

void Run::warn_of_drained_slosh() {
  const System& system = ode_.system();
  for (size_t i = 0; i < system.tree.tanks.size(); ++i) {
    const Tank& tank = system.tree.tanks[i];
    if (tank.reserve <= 0 || ode_.data().tree.tanks[i].mass > tank.reserve * (1 + kDrained)) continue;
    diagnostics_.warning("run.slosh-drained", tank.at,
                         "tank '" + tank.name + "' has used all but the mass " + short_text(tank.reserve) +
                             " of its slosh pendulum, and its thrusters have stopped",
                         "run the burn in parts, each with the slosh of its fill level, or leave slosh out");
  }
}

SimulateOutcome Run::close(double t, const std::string& reason) {
  sink_.end(true, reason);
  tell_consumption();
  warn_of_drained_slosh();
  const double worst = monitor_.worst(), limit = spec_.simulation.energy_error_limit;
  const bool is_kept = worst <= limit;
  if (worst > kEnergyWarning * limit) {
    const std::string what = "the energy balance is off by " + short_text(worst) +
                             " of the energy at t = " + short_text(monitor_.time_of_worst());
    const bool is_fixed = setup_.integrator == "rk4" || setup_.integrator == "implicit";
    const std::string advice =
        std::string(is_fixed ? "shorten step" : "tighten relative_tolerance and absolute_tolerance") +
        ", look for a motion whose position or rate jumps, or raise energy_error_limit";
    if (is_kept)
      diagnostics_.warning("run.energy-drift", spec_.simulation.at, what, advice);
    else
      diagnostics_.error("run.energy-error", spec_.simulation.at,
                         what + ", more than energy_error_limit = " + short_text(limit), advice);
  }
  return {true, t, reason, progress_, worst, is_kept};
}

}  // namespace bough::solver
