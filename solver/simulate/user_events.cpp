#include "solver/simulate/user_events.hpp"
#include "solver/text/names.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "formats/records/signal_name.hpp"

namespace bough::solver {
namespace {

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

class Resolver {
 public:
  Resolver(const records::SystemSpec& spec, const Outputs& recorder, bool is_valid, Diagnostics& diagnostics)
      : spec_(spec), recorder_(recorder), is_valid_(is_valid), diagnostics_(diagnostics) {}

  void check_time(const records::UserEventRecord& r) {
    const auto& s = spec_.simulation;
    if (!std::isfinite(*r.time)) {
      error(r, "run.bad-event", "is at a time that is not a finite number", "give a time of the run");
    } else if (*r.time < s.start || *r.time > s.start + s.duration) {
      std::ostringstream what;
      what << "event '" << r.name << "' is at t = " << *r.time << ", outside the run from " << s.start << " to "
           << s.start + s.duration;
      diagnostics_.warning("run.event-never", r.at, what.str(), "it will not come");
    }
  }

  int find(const records::UserEventRecord& r) {
    const auto name = records::parse_signal_name(r.signal);
    int size = 0;
    std::string description;
    std::vector<std::string> known;
    for (const auto& channel : recorder_.channels()) {
      if (channel.path == name.path) {
        size = channel.size;
        description = channel.description;
      }
      known.push_back(channel.path.starts_with("/sensors/") ? channel.path.substr(9) : channel.path);
    }
    if (size == 0) {
      if (!is_valid_) return -1;
      error(r, "run.unknown-signal", "watches '" + r.signal + "', which is no sensor and no channel of the results",
            suggest_name(r.signal.substr(0, r.signal.rfind(':')), known,
                         "name a sensor as tip:x, or a channel as /hinges/root/q:1"));
      return -1;
    }
    const int component = records::find_component(name, size, description);
    if (component >= 0) return recorder_.find(name.path, component);
    if (!is_valid_) return -1;
    const auto names = list(records::get_component_names(name.path, size, description));
    error(r, "run.unknown-signal",
          "watches '" + r.signal + "', but " +
              (name.component.empty() ? "does not say which component"
                                      : "there is no component '" + name.component + "'"),
          names.empty() ? "it is a scalar: leave the component out" : "its components are " + names);
    return -1;
  }

  void error(const records::UserEventRecord& r, const char* id, const std::string& what, const std::string& advice) {
    diagnostics_.error(id, r.at, "event '" + r.name + "' " + what, advice);
  }

 private:
  const records::SystemSpec& spec_;
  const Outputs& recorder_;
  bool is_valid_;
  Diagnostics& diagnostics_;
};

double sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

}  // namespace

UserEvents UserEvents::build(const records::SystemSpec& spec, const Outputs& recorder, bool system_is_valid,
                             Diagnostics& diagnostics) {
  UserEvents made;
  Resolver resolver(spec, recorder, system_is_valid, diagnostics);
  for (const auto& r : spec.events) {
    if (r.time) {
      resolver.check_time(r);
      made.index_.push_back(-1);
    } else {
      made.index_.push_back(resolver.find(r));
      ++made.num_signals_;
    }
    if (!std::isfinite(r.value))
      resolver.error(r, "run.bad-event", "has a value that is not a finite number", "give one");
    if (!(r.tolerance >= 0) || !std::isfinite(r.tolerance))
      resolver.error(r, "run.bad-event", "has a tolerance that is not a positive number", "give one, or leave it out");
    made.records_.push_back(r);
  }
  made.signs = made.make_gaps();
  return made;
}

std::vector<double> UserEvents::collect_times(bool log_only) const {
  std::vector<double> times;
  for (const auto& r : records_) {
    if (r.time && (r.action == records::EventAction::Log) == log_only) times.push_back(*r.time);
  }
  return times;
}

std::string UserEvents::describe(size_t trigger) const {
  const auto& r = records_[trigger];
  std::ostringstream text;
  text << "event '" << r.name << "'";
  if (!r.time)
    text << ": " << r.signal << (signs[static_cast<Eigen::Index>(trigger)] > 0 ? " rises" : " falls") << " through "
         << r.value;
  return text.str();
}

void UserEvents::calc_gaps(const VectorXd& sample, VectorXd& gaps) const {
  for (size_t i = 0; i < records_.size(); ++i) {
    gaps[static_cast<Eigen::Index>(i)] =
        index_[i] < 0 ? std::numeric_limits<double>::quiet_NaN() : sample[index_[i]] - records_[i].value;
  }
}

void UserEvents::start(const VectorXd& gaps) { signs = gaps.unaryExpr(&sign_of); }

void UserEvents::find_crossed(const VectorXd& gaps, std::vector<size_t>& crossed) {
  for (size_t i = 0; i < records_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double now = sign_of(gaps[row]), before = signs[row];
    if (now == 0) continue;
    signs[row] = now;
    if (before == 0 || before == now) continue;
    const auto direction = records_[i].direction;
    if (direction == records::EventDirection::Rising && now < 0) continue;
    if (direction == records::EventDirection::Falling && now > 0) continue;
    crossed.push_back(i);
  }
}

void UserEvents::find_due(double t, double resolution, std::vector<Occurrence>& due) const {
  for (size_t i = 0; i < records_.size(); ++i) {
    if (records_[i].time && std::abs(*records_[i].time - t) <= resolution) due.push_back({t, i});
  }
}

}  // namespace bough::solver
