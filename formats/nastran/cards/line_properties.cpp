#include <algorithm>
#include <limits>

#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/sections.hpp"
#include "formats/nastran/detail/shared_fields.hpp"

namespace bough::nastran::detail {
namespace {

using records::PbeamlStation;
using records::PbeamStation;

void read_recovery(Card& card, int first, std::array<Eigen::Vector2d, 4>& points) {
  static constexpr std::array names{"C1 C2", "D1 D2", "E1 E2", "F1 F2"};
  for (std::size_t i = 0; i < 4; ++i) points[i] = card.read_point(first + 2 * static_cast<int>(i), names[i]);
}

/// Blank and 0.0 both mean that the section has no shear flexibility.
std::optional<double> read_shear_factor(Card& card, int i, const char* what) {
  const auto k = card.read_optional_real(i, what);
  return k && *k != 0.0 ? k : std::nullopt;
}

void parse_pbar(Card& card, Reading& r) {
  records::Pbar p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  card.read_reals(2, {{"A", p.A, 0.0}, {"I1", p.I1, 0.0}, {"I2", p.I2, 0.0}, {"J", p.J, 0.0}, {"NSM", p.nsm, 0.0}});
  for (auto& point : p.recovery) point.setZero();
  read_recovery(card, 8, p.recovery);
  p.k1 = read_shear_factor(card, 16, "K1");
  p.k2 = read_shear_factor(card, 17, "K2");
  p.I12 = card.read_real(18, "I12", 0.0);
  p.at = card.get_location();
  card.demand(p.A >= 0, 2, "A", "an area that is not negative");
  card.demand(p.I1 >= 0, 3, "I1", "a value that is not negative");
  card.demand(p.I2 >= 0, 4, "I2", "a value that is not negative");
  if (p.I12 != 0 && p.I1 * p.I2 <= p.I12 * p.I12)
    card.fail("deck.field-range", 18, "I12 is " + std::string(card.get(18)) + ", expected I12^2 < I1 I2");
  if (r.claim(IdSpace::BarProperty, p.id, card)) r.deck.pbar.push_back(p);
}

/// Group and shape; 0 dimensions when the shape is not known (reported).
int read_shape(Card& card, std::string& shape) {
  card.use(2);
  if (!card.is_blank(2) && !card.is_word(2, "MSCBML0"))
    card.fail("deck.bad-word", 2, "section group is '" + std::string(card.get(2)) + "', expected MSCBML0",
              "other groups of sections are not read; give the dimensions of an MSCBML0 shape");
  shape = card.get_upper(3);
  const int count = get_num_dimensions(shape);
  if (count == 0) {
    const auto nearest = find_nearest(shape, get_shapes());
    card.fail("deck.unknown-shape", 3, "section shape '" + std::string(card.get(3)) + "' is not known",
              nearest.empty() ? "write one of the shapes of PBARL and PBEAML" : "did you mean " + nearest);
  }
  return count;
}

void read_dimensions(Card& card, int first, int count, std::vector<double>& dims) {
  for (int i = first; i < first + count; ++i) {
    dims.push_back(card.read_real(i, "DIM"));
    card.demand(card.is_blank(i) || dims.back() >= 0, i, "DIM", "a dimension that is not negative");
  }
}

void parse_pbarl(Card& card, Reading& r) {
  records::Pbarl p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  const int count = read_shape(card, p.shape);
  read_dimensions(card, 8, count, p.dims);
  if (count > 0) {
    p.nsm = card.read_real(8 + count, "NSM", 0.0);
    if (card.get_size() > 9 + count)
      card.fail("deck.too-many-fields", 9 + count,
                "shape " + p.shape + " has " + std::to_string(count) + " dimensions and NSM, found more fields",
                "remove them or correct the shape");
  }
  p.at = card.get_location();
  if (r.claim(IdSpace::BarProperty, p.id, card)) r.deck.pbarl.push_back(std::move(p));
}

/// X/XB of a station: blank is end B.
double read_station_position(Card& card, int i) {
  const double x = card.read_real(i, "X/XB", 1.0);
  card.demand(x > 0 && x <= 1, i, "X/XB", "a position above 0 and up to 1");
  return x;
}

/// Puts stations in order from end A to end B and reports two at one place.
template <class Station>
void sort_stations(Card& card, std::vector<Station>& stations) {
  std::stable_sort(stations.begin(), stations.end(),
                   [](const Station& a, const Station& b) { return a.x_over_L < b.x_over_L; });
  for (std::size_t i = 1; i < stations.size(); ++i)
    if (stations[i].x_over_L == stations[i - 1].x_over_L)
      card.fail("deck.field-range", 8, "two stations at X/XB = " + std::to_string(stations[i].x_over_L),
                "give every station another position");
}

/// A beam section as read: NaN where a field was blank, to be filled from both ends.
constexpr double blank = std::numeric_limits<double>::quiet_NaN();

double fill(double value, double a, double b, double x) { return value == value ? value : a + x * (b - a); }

constexpr std::array<double PbeamStation::*, 6> station_values{
    &PbeamStation::A, &PbeamStation::I1, &PbeamStation::I2, &PbeamStation::I12, &PbeamStation::J, &PbeamStation::nsm};

void read_station_values(Card& card, int first, double fallback, PbeamStation& station) {
  constexpr std::array<const char*, 6> names{"A", "I1", "I2", "I12", "J", "NSM"};
  for (std::size_t i = 0; i < names.size(); ++i)
    station.*station_values[i] = card.read_real(first + static_cast<int>(i), names[i], fallback);
}

bool is_station(const Card& card, int i) {
  return card.is_word(i, "YES") || card.is_word(i, "YESA") || card.is_word(i, "NO");
}

/// Blank values: end B takes those of end A, stations between are interpolated.
void fill_stations(std::vector<PbeamStation>& stations) {
  const PbeamStation a = stations.front();
  if (stations.back().x_over_L < 1) {
    stations.push_back(a);
    stations.back().x_over_L = 1;
  }
  for (const auto value : station_values) {
    double& b = stations.back().*value;
    b = fill(b, a.*value, a.*value, 1);
    for (auto& station : stations) station.*value = fill(station.*value, a.*value, b, station.x_over_L);
  }
}

void parse_pbeam(Card& card, Reading& r) {
  records::Pbeam p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  p.at = card.get_location();
  PbeamStation a;
  for (auto& point : a.recovery) point.setZero();
  read_station_values(card, 2, 0.0, a);
  card.demand(a.A > 0, 2, "A", "a positive area");
  card.demand(a.I1 >= 0, 3, "I1", "a value that is not negative");
  card.demand(a.I2 >= 0, 4, "I2", "a value that is not negative");
  int i = 8;
  if (!is_station(card, i)) {
    read_recovery(card, i, a.recovery);
    i += 8;
  }
  p.stations.push_back(a);
  while (is_station(card, i)) {
    PbeamStation station;
    for (auto& point : station.recovery) point.setZero();
    station.x_over_L = read_station_position(card, i + 1);
    read_station_values(card, i + 2, blank, station);
    card.use(i);
    if (card.is_word(i, "YESA")) station.recovery = a.recovery;
    const bool has_points = card.is_word(i, "YES") && !is_station(card, i + 8);
    i += 8;
    if (has_points) {
      read_recovery(card, i, station.recovery);
      i += 8;
    }
    p.stations.push_back(station);
  }
  sort_stations(card, p.stations);
  fill_stations(p.stations);
  p.k1 = card.read_optional_real(i, "K1");
  p.k2 = card.read_optional_real(i + 1, "K2");
  p.s1 = card.read_real(i + 2, "S1", 0.0);
  p.s2 = card.read_real(i + 3, "S2", 0.0);
  p.nsi_a = card.read_real(i + 4, "NSI(A)", 0.0);
  p.nsi_b = card.read_real(i + 5, "NSI(B)", p.nsi_a);
  p.cw_a = card.read_real(i + 6, "CW(A)", 0.0);
  p.cw_b = card.read_real(i + 7, "CW(B)", p.cw_a);
  i += 8;
  p.m1_a = card.read_real(i, "M1(A)", 0.0);
  p.m2_a = card.read_real(i + 1, "M2(A)", 0.0);
  p.m1_b = card.read_real(i + 2, "M1(B)", p.m1_a);
  p.m2_b = card.read_real(i + 3, "M2(B)", p.m2_a);
  p.n1_a = card.read_real(i + 4, "N1(A)", 0.0);
  p.n2_a = card.read_real(i + 5, "N2(A)", 0.0);
  p.n1_b = card.read_real(i + 6, "N1(B)", p.n1_a);
  p.n2_b = card.read_real(i + 7, "N2(B)", p.n2_a);
  if (card.get_size() > i + 8)
    card.fail("deck.too-many-fields", i + 8, "more lines than the stations and the last two lines of the card",
              "a station begins with YES, YESA or NO");
  if (r.claim(IdSpace::BeamProperty, p.id, card)) r.deck.pbeam.push_back(std::move(p));
}

void parse_pbeaml(Card& card, Reading& r) {
  records::Pbeaml p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  p.at = card.get_location();
  const int count = read_shape(card, p.shape);
  if (count == 0) return;
  PbeamlStation a;
  read_dimensions(card, 8, count, a.dims);
  a.nsm = card.read_real(8 + count, "NSM(A)", 0.0);
  p.stations.push_back(a);
  // The stations follow without gaps: SO, X, dimensions, NSM.
  for (int i = 9 + count; i < card.get_size(); i += count + 3) {
    card.read_word(i, "SO", "YES", {"YES", "YESA", "NO"});
    PbeamlStation station;
    station.x_over_L = read_station_position(card, i + 1);
    for (int j = 0; j < count; ++j) {
      station.dims.push_back(card.read_real(i + 2 + j, "DIM", blank));
      card.demand(card.is_blank(i + 2 + j) || station.dims.back() >= 0, i + 2 + j, "DIM",
                  "a dimension that is not negative");
    }
    station.nsm = card.read_real(i + 2 + count, "NSM", blank);
    p.stations.push_back(std::move(station));
  }
  sort_stations(card, p.stations);
  if (p.stations.back().x_over_L < 1) {
    p.stations.push_back(a);
    p.stations.back().x_over_L = 1;
  }
  auto& b = p.stations.back();
  b.nsm = fill(b.nsm, a.nsm, a.nsm, 1);
  for (std::size_t j = 0; j < a.dims.size(); ++j) b.dims[j] = fill(b.dims[j], a.dims[j], a.dims[j], 1);
  for (auto& station : p.stations) {
    station.nsm = fill(station.nsm, a.nsm, b.nsm, station.x_over_L);
    for (std::size_t j = 0; j < a.dims.size(); ++j)
      station.dims[j] = fill(station.dims[j], a.dims[j], b.dims[j], station.x_over_L);
  }
  if (r.claim(IdSpace::BeamProperty, p.id, card)) r.deck.pbeaml.push_back(std::move(p));
}

void parse_prod(Card& card, Reading& r) {
  records::Prod p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  read_rod_section(card, 2, p);
  if (r.claim(IdSpace::RodProperty, p.id, card)) r.deck.prod.push_back(p);
}

/// A wall thickness that is blank or zero means a solid circle.
void parse_ptube(Card& card, Reading& r) {
  records::Ptube p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  card.read_reals(2, {{"OD", p.od}, {"T", p.t, 0.0}, {"NSM", p.nsm, 0.0}});
  p.od2 = card.read_optional_real(5, "OD2");
  p.at = card.get_location();
  card.demand(card.is_blank(2) || p.od > 0, 2, "OD", "a positive diameter");
  card.demand(p.t >= 0 && 2 * p.t <= p.od * (1 + 1e-6), 3, "T", "a thickness between 0 and OD/2");
  card.demand(!p.od2 || *p.od2 > 0, 5, "OD2", "a positive diameter");
  if (p.t == 0) p.t = p.od / 2;
  if (r.claim(IdSpace::TubeProperty, p.id, card)) r.deck.ptube.push_back(p);
}

using Recovery = std::array<Eigen::Vector2d, 4>;

bool is_zero(const Recovery& points) {
  return std::all_of(points.begin(), points.end(), [](const auto& p) { return p.isZero(0.0); });
}

void add_recovery(CardFields& card, const Recovery& points) {
  for (const auto& p : points) card.add(p[0]).add(p[1]);
}

void add_section(CardFields& card, const records::PbeamStation& s) {
  card.add(s.A).add(s.I1).add(s.I2).add(s.I12).add(s.J).add(s.nsm);
}

/// A section of every station, so that nothing is left to the rules for blanks.
void write_pbeam(const records::Pbeam& p, CardSink& sink) {
  CardFields card("PBEAM");
  const auto& a = p.stations.front();
  card.add(p.id).add(p.mid);
  add_section(card, a);
  if (!is_zero(a.recovery)) add_recovery(card, a.recovery);
  for (std::size_t i = 1; i < p.stations.size(); ++i) {
    const auto& s = p.stations[i];
    const bool has_none = is_zero(s.recovery), is_as_a = s.recovery == a.recovery;
    card.add_word(has_none ? "NO" : is_as_a ? "YESA" : "YES").add(s.x_over_L);
    add_section(card, s);
    if (!has_none && !is_as_a) add_recovery(card, s.recovery);
  }
  card.add(p.k1);
  card.add(p.k2);
  const std::array<double, 14> rest{p.s1,   p.s2,   p.nsi_a, p.nsi_b, p.cw_a, p.cw_b, p.m1_a,
                                    p.m2_a, p.m1_b, p.m2_b,  p.n1_a,  p.n2_a, p.n1_b, p.n2_b};
  if (std::any_of(rest.begin(), rest.end(), [](double x) { return x != 0; }))
    for (const double x : rest) card.add(x);
  sink.put(card);
}

void write_pbars(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pbar) {
    CardFields card("PBAR");
    card.add(p.id).add(p.mid).add(p.A).add(p.I1).add(p.I2).add(p.J).add(p.nsm).end_line();
    const bool more = p.k1 || p.k2 || p.I12 != 0;
    if (more || !is_zero(p.recovery)) add_recovery(card, p.recovery);
    if (more) {
      card.add(p.k1);
      card.add(p.k2);
      card.add(p.I12);
    }
    sink.put(card);
  }
}

void write_pbarls(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pbarl) {
    CardFields card("PBARL");
    card.add(p.id).add(p.mid).add_blank().add_word(p.shape).end_line();
    for (const double dim : p.dims) card.add(dim);
    sink.put(card.add(p.nsm));
  }
}

void write_pbeams(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pbeam) write_pbeam(p, sink);
}

void write_pbeamls(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pbeaml) {
    CardFields card("PBEAML");
    card.add(p.id).add(p.mid).add_blank().add_word(p.shape).end_line();
    for (std::size_t i = 0; i < p.stations.size(); ++i) {
      const auto& s = p.stations[i];
      if (i > 0) card.add_word("YES").add(s.x_over_L);
      for (const double dim : s.dims) card.add(dim);
      card.add(s.nsm);
    }
    sink.put(card);
  }
}

void write_prods(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.prod)
    sink.put(CardFields("PROD").add(p.id).add(p.mid).add(p.A).add(p.J).add(p.c).add(p.nsm));
}

void write_ptubes(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.ptube) {
    CardFields card("PTUBE");
    card.add(p.id).add(p.mid).add(p.od).add(p.t).add(p.nsm);
    card.add(p.od2);
    sink.put(card);
  }
}

void convert_pbeam(UnitConverter& u) {
  const auto scale_station = [&](int first) {
    u.scale(first, "A");
    u.scale(first + 1, first + 4, "I");
    u.scale(first + 5, "N");
  };
  const auto begins_station = [&](int first) {
    return is_word(u.get(first), "YES") || is_word(u.get(first), "YESA") || is_word(u.get(first), "NO");
  };
  scale_station(2);
  int line = 8;
  if (!begins_station(line)) {
    u.scale(line, line + 7, "L");
    line += 8;
  }
  while (line < u.size() && begins_station(line)) {
    scale_station(line + 2);
    const bool has_points = is_word(u.get(line), "YES");
    line += 8;
    if (!has_points || begins_station(line)) continue;
    u.scale(line, line + 7, "L");
    line += 8;
  }
  // K1 K2 S1 S2 NSI(A) NSI(B) CW(A) CW(B), then the offsets of the mass and of the neutral axis.
  u.scale(line + 4, line + 5, "ML");
  u.scale(line + 6, line + 7, "L6");
  u.scale(line + 8, line + 15, "L");
}

void convert_section(UnitConverter& u) {
  const int dims = get_num_dimensions(make_upper(u.get(3)));
  if (dims == 0) return u.fail(3, "the section is not known");
  u.scale(8, 8 + dims - 1, "L");
  u.scale(8 + dims, "N");
  if (u.get_name() == "PBARL") return;
  for (int station = 9 + dims; station < u.size(); station += dims + 3) {
    u.scale(station + 2, station + 1 + dims, "L");
    u.scale(station + 2 + dims, "N");
  }
}

}  // namespace

void add_line_property_parsers(ParserTable& table) {
  table["PBAR"] = {parse_pbar, ". . A I I I N . L L L L L L L L . . I",
                   "PID MID A I1 I2 J NSM - C1 C2 D1 D2 E1 E2 F1 F2 K1 K2 I12"};
  table["PBARL"] = {parse_pbarl, nullptr,
                    "PID MID GROUP TYPE - - - - DIM1 DIM2 DIM3 DIM4 DIM5 DIM6 DIM7 DIM8 DIM9 DIM10"};
  table["PBEAM"] = {parse_pbeam, nullptr, "PID MID A I1 I2 I12 J NSM C1 C2 D1 D2 E1 E2 F1 F2"};
  table["PBEAML"] = {parse_pbeaml, nullptr,
                     "PID MID GROUP TYPE - - - - DIM1 DIM2 DIM3 DIM4 DIM5 DIM6 DIM7 DIM8 DIM9 DIM10"};
  table["PROD"] = {parse_prod, ". . A I L N", "PID MID A J C NSM"};
  table["PTUBE"] = {parse_ptube, ". . L L N L", "PID MID OD T NSM OD2"};
  table["PBEAM"].convert = convert_pbeam;
  table["PBARL"].convert = table["PBEAML"].convert = convert_section;
  write_by(table, {{"PBAR", write_pbars},
                   {"PBARL", write_pbarls},
                   {"PBEAM", write_pbeams},
                   {"PBEAML", write_pbeamls},
                   {"PROD", write_prods},
                   {"PTUBE", write_ptubes}});
}

}  // namespace bough::nastran::detail
