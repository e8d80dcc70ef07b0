#include "modal/response/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "fe/loads/loads.hpp"
#include "fe/statics/static_case.hpp"
#include "modal/complex/rotor_case.hpp"

namespace bough::modal::response {
namespace {

using records::DynamicLoad;
using Kind = DynamicLoad::Kind;

/// Round-off of the ratio of two spin rates.
constexpr double kRateNoise = 1e-9;

const char* get_name(const DynamicLoad& load) {
  static constexpr const char* names[] = {"RLOAD1", "RLOAD2", "TLOAD1", "TLOAD2"};
  return names[static_cast<int>(load.kind)];
}
std::string describe_load(const DynamicLoad& load) {
  return get_name(load) + std::string(" ") + std::to_string(load.sid);
}
bool is_over_time(const DynamicLoad& load) { return load.kind == Kind::Tload1 || load.kind == Kind::Tload2; }

template <class Cards>
bool has_set(const Cards& cards, int sid) {
  return std::any_of(cards.begin(), cards.end(), [sid](const auto& card) { return card.sid == sid; });
}

/// Static loads under this id, SPCD aside.
bool has_load_cards(const records::Deck& deck, int set) {
  const auto& c = deck.load_cards;
  return has_set(deck.point_loads, set) || has_set(deck.gravity, set) || has_set(c.directed, set) ||
         has_set(c.beams, set) || has_set(c.grid_pressures, set) || has_set(c.pressures, set) ||
         has_set(c.rotations, set) || has_set(c.scalar, set) || has_set(deck.loads, set) ||
         has_set(deck.special.accelerations, set);
}

/// One pattern of a card, and the delay and phase of its dofs.
struct Part {
  VectorXd pattern;
  double delay = 0, phase_deg = 0;
};

class Collector {
 public:
  Collector(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
            bool over_time, Diagnostics& diagnostics)
      : model_(model), deck_(deck), subcase_(subcase), over_time_(over_time), diagnostics_(diagnostics) {}

  Excitation collect() {
    const int set = subcase_.dynamics.dload;
    const auto& d = deck_.dynamics;
    if (set == 0 && over_time_ && subcase_.dynamics.ic != 0) {  // an initial motion is a cause by itself
      result_.F.resize(model_.num_gdofs(), 0);
      result_.D.resize(static_cast<Eigen::Index>(model_.fixed_dofs().size()), 0);
      return std::move(result_);
    }
    const auto& unbalances = d.rotors.unbalances;
    if (!has_set(d.loads, set) && !has_set(d.sums, set) && !has_set(unbalances, set)) {
      diagnostics_.error("modal.no-dynamic-load", deck_.locate(subcase_.find_command("DLOAD")),
                         set == 0
                             ? "subcase " + std::to_string(subcase_.id) + " selects no DLOAD"
                             : "DLOAD = " + std::to_string(set) + " names no DLOAD, RLOAD or TLOAD card of the deck",
                         "write DLOAD = n in the case control and add the cards");
      return {};
    }
    for (const auto& sum : d.sums)
      if (sum.sid == set && has_set(d.loads, set))
        diagnostics_.error("modal.wrong-load", deck_.locate(sum.at),
                           "DLOAD " + std::to_string(set) + " has the id of a load card, " +
                               describe_load(*std::find_if(d.loads.begin(), d.loads.end(),
                                                           [set](const auto& l) { return l.sid == set; })),
                           "give the DLOAD card a different id");
    for (const auto& load : d.loads)
      if (load.sid == set) add(load, 1);
    for (const auto& sum : d.sums)
      if (sum.sid == set) add(sum);
    for (const auto& unbalance : unbalances)
      if (unbalance.sid == set) add(unbalance, 1);
    Excitation& e = result_;
    e.F = join(forces_, model_.num_gdofs());
    e.D = join(motions_, static_cast<Eigen::Index>(model_.fixed_dofs().size()));
    return std::move(e);
  }

 private:
  static MatrixXd join(const std::vector<VectorXd>& columns, Eigen::Index rows) {
    MatrixXd A(rows, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) A.col(static_cast<Eigen::Index>(i)) = columns[i];
    return A;
  }

  void add(const records::DynamicLoadSum& sum) {
    for (const auto& [scale, sid] : sum.terms) {
      const auto id = sid;
      const auto& loads = deck_.dynamics.loads;
      const auto load = std::find_if(loads.begin(), loads.end(), [id](const auto& l) { return l.sid == id; });
      bool is_found = load != loads.end();
      if (is_found) add(*load, sum.s * scale);
      for (const auto& unbalance : deck_.dynamics.rotors.unbalances) {
        if (unbalance.sid != id) continue;
        add(unbalance, sum.s * scale);
        is_found = true;
      }
      if (!is_found)
        diagnostics_.error("modal.missing-load", deck_.locate(sum.at),
                           "DLOAD " + std::to_string(sum.sid) + " names set " + std::to_string(sid) +
                               ", which no RLOAD, TLOAD or UNBALNC card of the deck has",
                           "add the card or correct the id");
    }
  }

  /// The force m r ω² (x - i s y) e^{iθ}: it turns with e^{iωt} in the direction of the spin, s the sign of its rate.
  void add(const records::Unbalance& u, double scale) {
    const auto wrong = [&](const char* id, const std::string& what, const char* advice) {
      diagnostics_.error(id, deck_.locate(u.at), "UNBALNC " + std::to_string(u.sid) + what, advice);
    };
    if (over_time_)
      return wrong("modal.rotor-unsupported", " is a load over frequency, found in a response over time",
                   "use bough frequency");
    const auto found = find_rotor(u.grid);
    if (!found) {
      if (!diagnostics_.has("modal.missing-rotor") && !diagnostics_.has("modal.rotor-line"))
        wrong("modal.unbalance-grid",
              " acts at grid " + std::to_string(u.grid) + ", which is on no rotor that RGYRO selects",
              "name a grid of ROTORG, and select RGYRO in the case control");
      return;
    }
    const fe::RotorAxis& rotor = rotors_->axes[*found];
    const fe::Vector3d& axis = rotor.axis;
    const auto& node = model_.node(model_.find_node(u.grid));
    fe::Vector3d x = node.R_basic_cd * fe::Vector3d(u.x[0], u.x[1], u.x[2]);
    x -= axis.dot(x) * axis;
    if (!(x.norm() > 1e-9 * fe::Vector3d(u.x[0], u.x[1], u.x[2]).norm()))
      return wrong("modal.unbalance-grid", ": X1 X2 X3 is along the axis of the rotor",
                   "give the direction of angle 0 across the axis");
    x.normalize();
    const fe::Vector3d y = axis.cross(x);
    ExcitationTerm term;
    term.unbalance = &u;
    set_spin(term, rotors_->relations[*found]);
    if (rotors_->is_synchronous && std::abs(term.spin_offset) + std::abs(std::abs(term.spin_slope) - 1) > kRateNoise)
      diagnostics_.warning("modal.unbalance-rate", deck_.locate(u.at),
                           "UNBALNC " + std::to_string(u.sid) + " acts at the frequency of the response, while rotor " +
                               std::to_string(rotor.id) + " turns at another rate than reference rotor " +
                               std::to_string(rotors_->reference) + ", which has that frequency",
                           "make rotor " + std::to_string(rotor.id) + " the reference (REFROTR of RGYRO)");
    const auto get = [&](int id) -> const records::DynamicTable* {
      if (id == 0) return nullptr;
      const auto* table = find_table(deck_, id);
      if (!table)
        wrong("modal.missing-table",
              " names table " + std::to_string(id) + ", which no TABLED1 to TABLED4 card of the deck has",
              "add the table or correct the id");
      return table;
    };
    term.table_a = get(u.mass_table);
    term.table_b = get(u.radius_table);
    term.table_c = get(u.offset_table);
    term.scale = scale * model_.wtmass();
    for (const bool is_moment : {false, true}) {
      if (is_moment && u.offset == 0 && u.offset_table == 0) continue;
      for (const bool is_second : {false, true}) {
        const fe::Vector3d force = is_second ? y : x;
        VectorXd pattern = VectorXd::Zero(model_.num_gdofs());
        pattern.segment<3>(node.first_gdof + (is_moment ? 3 : 0)) = is_moment ? fe::Vector3d(axis.cross(force)) : force;
        term.is_moment = is_moment;
        term.phase_deg = u.angle_deg;
        term.is_second = is_second;
        term.column = static_cast<int>(forces_.size());
        forces_.push_back(pattern);
        result_.forces.push_back(term);
      }
    }
  }

  /// Spin rate over the frequency: of synchronous analyses along a line, else that at the speed of RGYRO.
  void set_spin(ExcitationTerm& term, const rotors::SpeedRelation& relation) const {
    if (!rotors_->is_synchronous)
      term.spin_offset = relation.evaluate(rotors_->speeds.empty() ? 0 : rotors_->speeds.front());
    else if (const auto line = relation.find_line())
      std::tie(term.spin_offset, term.spin_slope) = *line;
  }

  /// Index of the rotor with the grid; errors of the rotors are reported where they are made.
  std::optional<std::size_t> find_rotor(int grid) {
    if (!rotors_) {
      Diagnostics unreported;
      rotors_ = rotors::choose_rotors(model_, deck_, subcase_, rotors::RotorUse::Frequency, unreported);
      if (!rotors_) rotors_.emplace();
      if (unreported.num_errors() > 0)
        for (const auto& item : unreported.items()) diagnostics_.add(item);
    }
    for (std::size_t i = 0; i < rotors_->axes.size(); ++i)
      if (const auto& on = rotors_->axes[i].grids; std::find(on.begin(), on.end(), grid) != on.end()) return i;
    return std::nullopt;
  }

  const records::DynamicTable* get_table(const DynamicLoad& load, int id) {
    if (id == 0) return nullptr;
    const auto* table = find_table(deck_, id);
    if (!table)
      diagnostics_.error("modal.missing-table", deck_.locate(load.at),
                         describe_load(load) + " names table " + std::to_string(id) +
                             ", which no TABLED1 to TABLED4 card of the deck has",
                         "add the table or correct the id");
    return table;
  }

  void add(const DynamicLoad& load, double scale) {
    if (is_over_time(load) != over_time_) {
      diagnostics_.error("modal.wrong-load", deck_.locate(load.at),
                         describe_load(load) + " is a load over " + (over_time_ ? "frequency" : "time") +
                             ", found in a response over " + (over_time_ ? "time" : "frequency"),
                         over_time_ ? "give TLOAD1 or TLOAD2, or use bough frequency"
                                    : "give RLOAD1 or RLOAD2, or use bough transient");
      return;
    }
    ExcitationTerm term;
    term.card = &load;
    term.scale = scale;
    term.table_a = get_table(load, load.table_a);
    term.table_b = get_table(load, load.table_b);
    const bool is_motion = load.excitation != DynamicLoad::Excitation::Force;
    auto& store = is_motion ? motions_ : forces_;
    for (const auto& part : is_motion ? list_motions(load) : list_forces(load)) {
      term.delay = part.delay;
      term.phase_deg = part.phase_deg;
      const auto same = std::find_if(store.begin(), store.end(), [&](const auto& p) { return p == part.pattern; });
      term.column = static_cast<int>(same - store.begin());
      if (same == store.end()) store.push_back(part.pattern);
      (is_motion ? result_.motions : result_.forces).push_back(term);
    }
  }

  /// DAREA and static loads; LSEQ names these where LOADSET selects it.
  std::vector<Part> list_forces(const DynamicLoad& load) {
    VectorXd F = VectorXd::Zero(model_.num_gdofs());
    bool is_found = false;
    VectorXd F_cd = F;
    for (const auto& area : deck_.dynamics.areas) {
      if (area.sid != load.excite) continue;
      is_found = true;
      const int row = find_dof(model_, deck_, area.g, area.c, "DAREA", area.at, diagnostics_);
      if (row < 0) continue;
      F_cd[row] += area.value;
      if (area.value != 0 && is_held(row))
        diagnostics_.warning("modal.load-on-spc", deck_.locate(area.at),
                             "DAREA " + std::to_string(area.sid) + " acts on component " + std::to_string(area.c) +
                                 " of grid " + std::to_string(area.g) +
                                 ", which an SPC holds: it loads the support and moves nothing",
                             "load a free component, or move the support by SPCD with TYPE DISP, VELO or ACCE");
    }
    turn_to_basic(model_, F_cd);
    F += F_cd;
    int set = load.excite;
    for (const auto& s : deck_.dynamics.lseq) {
      if (subcase_.dynamics.loadset == 0 || s.sid != subcase_.dynamics.loadset || s.excite != load.excite) continue;
      set = s.load;
      is_found = true;
      if (s.temperature != 0)
        diagnostics_.error("modal.unsupported-load", deck_.locate(s.at),
                           "LSEQ " + std::to_string(s.sid) + " names temperatures (TID " +
                               std::to_string(s.temperature) + "), which load no response here",
                           "leave TID out, or give the loads as forces");
    }
    if (set != 0 && has_load_cards(deck_, set)) {
      is_found = true;
      F += calc_load(model_, deck_, set, diagnostics_);
    }
    if (!is_found) report_missing(load, has_set(deck_.load_cards.spcd, load.excite));
    if (const auto lost = fe::list_lost_loads(model_, F); F.size() > 0 && !lost.empty())
      diagnostics_.warning("fe.load-autospc", deck_.locate(load.at),
                           describe_load(load) + " acts on " + std::to_string(lost.size()) +
                               " dof(s) without stiffness, which AUTOSPC holds: " + lost.front() +
                               (lost.size() > 1 ? ", ..." : ""),
                           "a moment on a grid of solids needs an RBE2 or RBE3 that ties it to other grids");
    turn_to_cd(model_, F);
    auto parts = split(load, F, [](int row) { return row; });
    for (auto& part : parts) turn_to_basic(model_, part.pattern);
    return parts;
  }

  /// Returns true if an SPC of the subcase, of the grid or of the model holds a row of the g-set in CD axes.
  bool is_held(int row) const {
    const auto& fixed = model_.fixed_dofs();
    if (!std::binary_search(fixed.begin(), fixed.end(), row)) return false;
    return std::none_of(model_.autospc().begin(), model_.autospc().end(), [&](const auto& entry) {
      return model_.node(model_.find_node(entry.node)).first_gdof + std::max(entry.component - 1, 0) == row;
    });
  }

  std::vector<Part> list_motions(const DynamicLoad& load) {
    const auto& fixed = model_.fixed_dofs();
    VectorXd d = VectorXd::Zero(static_cast<Eigen::Index>(fixed.size()));
    bool is_found = false;
    for (const auto& card : deck_.load_cards.spcd) {
      if (card.sid != load.excite) continue;
      is_found = true;
      for (int c = 0; c < 6; ++c) {
        if (card.c != 0 ? !(card.c >> c & 1u) : c > 0) continue;
        const int row = find_dof(model_, deck_, card.g, card.c != 0 ? c + 1 : 0, "SPCD", card.at, diagnostics_);
        if (row < 0) break;
        const auto at = std::lower_bound(fixed.begin(), fixed.end(), row);
        if (at != fixed.end() && *at == row)
          d[at - fixed.begin()] += card.d;
        else
          diagnostics_.error("fe.spcd-not-fixed", deck_.locate(card.at),
                             "SPCD moves grid " + std::to_string(card.g) + " component " +
                                 std::to_string(card.c != 0 ? c + 1 : 0) + ", which no SPC of the subcase fixes",
                             "fix it with the SPC set of the subcase");
      }
    }
    if (!is_found) report_missing(load, false);
    return split(load, d, [&](int i) { return fixed[static_cast<std::size_t>(i)]; });
  }

  void report_missing(const DynamicLoad& load, bool has_spcd) {
    const bool is_motion = load.excitation != DynamicLoad::Excitation::Force;
    diagnostics_.error("modal.missing-load", deck_.locate(load.at),
                       describe_load(load) + ": EXCITEID " + std::to_string(load.excite) + " names no " +
                           (is_motion ? "SPCD card" : "DAREA card, LSEQ or static load") + " of the deck",
                       has_spcd    ? "to move supports by SPCD, write TYPE DISP, VELO or ACCE"
                       : is_motion ? "add the SPCD cards of the supports that move"
                                   : "add the cards or correct the id");
  }

  /// Parts of `all` that have equal delay and phase; `get_row`: the g-row of an entry.
  template <class GetRow>
  std::vector<Part> split(const DynamicLoad& load, const VectorXd& all, const GetRow& get_row) {
    if (load.delay_set == 0 && load.phase_set == 0) return {{all, load.delay, load.phase_deg}};
    const auto delays = list_values(load, load.delay_set, deck_.dynamics.delays, "DELAY");
    const auto phases = list_values(load, load.phase_set, deck_.dynamics.phases, "DPHASE");
    const auto find = [](const std::map<int, double>& values, int row, int set, double otherwise) {
      if (set == 0) return otherwise;
      const auto found = values.find(row);
      return found == values.end() ? 0.0 : found->second;
    };
    std::map<std::pair<double, double>, VectorXd> groups;
    for (int i = 0; i < static_cast<int>(all.size()); ++i) {
      if (all[i] == 0) continue;
      const int row = get_row(i);
      const std::pair key{find(delays, row, load.delay_set, load.delay),
                          find(phases, row, load.phase_set, load.phase_deg)};
      auto& pattern = groups.try_emplace(key, VectorXd::Zero(all.size())).first->second;
      pattern[i] = all[i];
    }
    std::vector<Part> parts;
    for (auto& [key, pattern] : groups) parts.push_back({std::move(pattern), key.first, key.second});
    return parts;
  }

  std::map<int, double> list_values(const DynamicLoad& load, int set, const std::vector<records::DofValue>& cards,
                                    const char* name) {
    std::map<int, double> values;
    if (set == 0) return values;
    for (const auto& card : cards) {
      if (card.sid != set) continue;
      if (const int row = find_dof(model_, deck_, card.g, card.c, name, card.at, diagnostics_); row >= 0) {
        const auto [found, is_new] = values.emplace(row, card.value);
        if (!is_new && found->second != card.value)
          diagnostics_.error("modal.wrong-load", deck_.locate(card.at),
                             std::string(name) + " " + std::to_string(set) + " gives grid " + std::to_string(card.g) +
                                 " component " + std::to_string(card.c) + " two values",
                             "keep one of them");
      }
    }
    if (!has_set(cards, set))
      diagnostics_.error(
          "modal.missing-load", deck_.locate(load.at),
          describe_load(load) + " names " + name + " " + std::to_string(set) + ", which the deck does not have",
          "add the cards or correct the id");
    return values;
  }

  const fe::Model& model_;
  const records::DynamicDeck& deck_;
  const records::DynamicSubcase& subcase_;
  bool over_time_;
  Diagnostics& diagnostics_;
  std::vector<VectorXd> forces_, motions_;
  std::optional<rotors::RotorCase> rotors_;
  Excitation result_;
};

}  // namespace

int find_dof(const fe::Model& model, const records::DynamicDeck& deck, int g, int c, const std::string& card,
             const records::CardLocation& at, Diagnostics& diagnostics) {
  const int index = model.find_node(g);
  if (index < 0) {
    if (!model.is_refused(g) && deck.dynamics.extra_points.count(g) == 0)
      diagnostics.error("fe.missing-grid", deck.locate(at),
                        card + " names grid " + std::to_string(g) + ", which the deck does not define",
                        "add the GRID or correct the id");
    return -1;
  }
  const auto& node = model.node(index);
  if (node.num_dofs == 1) {
    if (c <= 1) return node.first_gdof;
    diagnostics.error(
        "fe.bad-component", deck.locate(at),
        card + " has component " + std::to_string(c) + " at scalar point " + std::to_string(g) + ", expected 0 or 1",
        "correct the component");
    return -1;
  }
  if (c == 0) {
    diagnostics.error("fe.bad-component", deck.locate(at),
                      card + " names grid " + std::to_string(g) + " without a component, expected 1 to 6",
                      "name the component; 0 is that of a scalar point");
    return -1;
  }
  return node.first_gdof + c - 1;
}

void turn_to_basic(const fe::Model& model, Eigen::Ref<VectorXd> u) {
  for (const auto& node : model.nodes())
    for (int i = 0; i < node.num_dofs / 3; ++i)
      u.segment<3>(node.first_gdof + 3 * i) = (node.R_basic_cd * u.segment<3>(node.first_gdof + 3 * i)).eval();
}
void turn_to_cd(const fe::Model& model, Eigen::Ref<VectorXd> u) {
  for (const auto& node : model.nodes())
    for (int i = 0; i < node.num_dofs / 3; ++i)
      u.segment<3>(node.first_gdof + 3 * i) =
          (node.R_basic_cd.transpose() * u.segment<3>(node.first_gdof + 3 * i)).eval();
}

Excitation calc_excitation(const fe::Model& model, const records::DynamicDeck& deck,
                           const records::DynamicSubcase& subcase, bool over_time, Diagnostics& diagnostics) {
  return Collector(model, deck, subcase, over_time, diagnostics).collect();
}

std::complex<double> calc_amplitude(const ExcitationTerm& term, double hz) {
  using std::numbers::pi;
  if (const auto* u = term.unbalance) {
    if (hz < u->from_hz || hz > u->to_hz) return 0;
    const double omega = 2 * pi * hz, mass = term.table_a ? evaluate(*term.table_a, hz) : u->mass,
                 radius = term.table_b ? evaluate(*term.table_b, hz) : u->radius,
                 arm = !term.is_moment ? 1
                       : term.table_c  ? evaluate(*term.table_c, hz)
                                       : u->offset;
    const double spin = term.spin_offset + term.spin_slope * omega, delay = !term.is_second ? 0 : spin < 0 ? -90 : 90;
    return std::polar(term.scale * mass * radius * omega * omega * arm, (term.phase_deg - delay) * pi / 180);
  }
  const auto& card = *term.card;
  const double a = term.table_a ? evaluate(*term.table_a, hz) : card.a;
  const double b = term.table_b ? evaluate(*term.table_b, hz) : card.b;
  const auto turn = std::polar(1.0, term.phase_deg * pi / 180 - 2 * pi * hz * term.delay);
  if (card.kind == Kind::Rload1) return term.scale * std::complex(a, b) * turn;
  return term.scale * a * std::polar(1.0, b * pi / 180) * turn;
}

double calc_history(const ExcitationTerm& term, double t, Side side, double reach) {
  using std::numbers::pi;
  const auto& card = *term.card;
  t -= term.delay;
  if (card.kind == Kind::Tload1) return term.scale * (term.table_a ? evaluate(*term.table_a, t, side, reach) : card.a);
  double s = t - card.t1;
  const double end = card.t2 - card.t1;
  if (s < -reach || s > end + reach) return 0;
  s = std::clamp(s, 0.0, end);
  const double value = term.scale * std::pow(s, card.power) * std::exp(card.growth * s) *
                       std::cos(2 * pi * card.frequency_hz * s + term.phase_deg * pi / 180);
  const bool is_start = s <= reach, is_end = s >= end - reach;
  if ((is_start && side == Side::Before) || (is_end && side == Side::After)) return 0;
  return (is_start || is_end) && side == Side::Mean ? 0.5 * value : value;
}

}  // namespace bough::modal::response
