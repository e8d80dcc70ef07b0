#include "tests/formats/nastran/compare_decks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "tests/support/paths.hpp"

namespace bough::nastran {
namespace {

using namespace records;

/// Flat lists of what a record holds: numbers to compare within the tolerance, and everything else as text.
class Content {
 public:
  Content& operator()(double x) {
    numbers.push_back(x);
    return *this;
  }
  Content& operator()(int i) { return (*this)(std::to_string(i)); }
  Content& operator()(unsigned i) { return (*this)(std::to_string(i)); }
  Content& operator()(bool b) { return (*this)(b ? 1 : 0); }
  Content& operator()(const char* word) { return (*this)(std::string(word)); }
  Content& operator()(const std::string& word) {
    words += word + ' ';
    return *this;
  }
  template <class Derived>
  Content& operator()(const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j) (*this)(static_cast<double>(m(i, j)));
    return *this;
  }
  template <class T>
  Content& operator()(const std::optional<T>& value) {
    return value ? (*this)("set")(*value) : (*this)("open");
  }
  template <class T>
  Content& operator()(const std::vector<T>& values) {
    (*this)(static_cast<int>(values.size()));
    for (const auto& value : values) (*this)(value);
    return *this;
  }
  template <class T, std::size_t n>
  Content& operator()(const std::array<T, n>& values) {
    for (const auto& value : values) (*this)(value);
    return *this;
  }

  Content& operator()(const Grid& r) { return (*this)(r.id)(r.cp)(r.x)(r.cd)(r.ps); }
  Content& operator()(const CoordSystem& r) {
    return (*this)(r.id)(static_cast<int>(r.kind))(r.by_grids)(r.grids)(r.rid)(r.a)(r.b)(r.c);
  }
  Content& operator()(const Mat1& r) {
    return (*this)(r.id)(r.E)(r.G)(r.nu)(r.rho)(r.alpha)(r.tref)(r.ge)(r.st)(r.sc)(r.ss);
  }
  Content& operator()(const Mat2& r) { return (*this)(r.id)(r.G)(r.rho)(r.alpha)(r.tref)(r.ge); }
  Content& operator()(const PlyStrength& r) { return (*this)(r.Xt)(r.Xc)(r.Yt)(r.Yc)(r.S)(r.F12)(r.is_strain); }
  Content& operator()(const Mat8& r) {
    return (*this)(r.id)(r.E1)(r.E2)(r.nu12)(r.G12)(r.G1z)(r.G2z)(r.rho)(r.a1)(r.a2)(r.tref)(r.ge)(r.strength);
  }
  Content& operator()(const Mat9& r) { return (*this)(r.id)(r.G)(r.rho)(r.alpha)(r.tref)(r.ge); }
  Content& operator()(const GridTemperature& r) { return (*this)(r.sid)(r.g)(r.t); }
  Content& operator()(const DefaultTemperature& r) { return (*this)(r.sid)(r.t); }
  Content& operator()(const BarTemperature& r) {
    return (*this)(r.sid)(r.element)(r.t_a)(r.t_b)(r.gradient_a)(r.gradient_b);
  }
  Content& operator()(const PlateTemperature& r) { return (*this)(r.sid)(r.element)(r.t)(r.gradient); }
  Content& operator()(const Pbar& r) {
    return (*this)(r.id)(r.mid)(r.A)(r.I1)(r.I2)(r.I12)(r.J)(r.nsm)(r.k1)(r.k2)(r.recovery);
  }
  Content& operator()(const Pbarl& r) { return (*this)(r.id)(r.mid)(r.shape)(r.dims)(r.nsm); }
  Content& operator()(const PbeamStation& r) {
    return (*this)(r.x_over_L)(r.A)(r.I1)(r.I2)(r.I12)(r.J)(r.nsm)(r.recovery);
  }
  Content& operator()(const Pbeam& r) {
    (*this)(r.id)(r.mid)(r.stations)(r.k1)(r.k2)(r.s1)(r.s2)(r.nsi_a)(r.nsi_b)(r.cw_a)(r.cw_b);
    return (*this)(r.m1_a)(r.m2_a)(r.m1_b)(r.m2_b)(r.n1_a)(r.n2_a)(r.n1_b)(r.n2_b);
  }
  Content& operator()(const PbeamlStation& r) { return (*this)(r.x_over_L)(r.dims)(r.nsm); }
  Content& operator()(const Pbeaml& r) { return (*this)(r.id)(r.mid)(r.shape)(r.stations); }
  Content& operator()(const Prod& r) { return (*this)(r.id)(r.mid)(r.A)(r.J)(r.c)(r.nsm); }
  Content& operator()(const Ptube& r) { return (*this)(r.id)(r.mid)(r.od)(r.t)(r.nsm)(r.od2); }
  Content& operator()(const Pelas& r) { return (*this)(r.id)(r.k)(r.ge)(r.s); }
  Content& operator()(const Pbush& r) { return (*this)(r.id)(r.k)(r.b)(r.ge)(r.mass); }
  Content& operator()(const Pmass& r) { return (*this)(r.id)(r.m); }
  Content& operator()(const Pshell& r) {
    return (*this)(r.id)(r.mid1)(r.mid2)(r.mid3)(r.mid4)(r.t)(r.bending_ratio)(r.shear_ratio)(r.nsm)(r.z1)(r.z2);
  }
  Content& operator()(const Ply& r) { return (*this)(r.mid)(r.t)(r.theta_deg); }
  Content& operator()(const Pcomp& r) {
    return (*this)(r.id)(r.z0)(r.nsm)(r.tref)(r.ge)(r.plies)(r.bending)(r.membrane)(static_cast<int>(r.layup))(r.sb)(
        r.failure);
  }
  Content& operator()(const Pshear& r) { return (*this)(r.id)(r.mid)(r.t)(r.nsm)(r.f1)(r.f2); }
  Content& operator()(const ShearPanel& r) { return (*this)(r.id)(r.pid)(r.grids); }
  Content& operator()(const Pbush1d& r) { return (*this)(r.id)(r.k)(r.c)(r.m); }
  Content& operator()(const Cbush1d& r) { return (*this)(r.id)(r.pid)(r.ga)(r.gb)(r.cid); }
  Content& operator()(const Pdamp& r) { return (*this)(r.id)(r.b); }
  Content& operator()(const ScalarDamper& r) {
    return (*this)(r.id)(r.pid)(r.b)(r.g1)(r.c1)(r.g2)(r.c2)(r.by_scalar_points);
  }
  Content& operator()(const Pvisc& r) { return (*this)(r.id)(r.ce)(r.cr); }
  Content& operator()(const Cvisc& r) { return (*this)(r.id)(r.pid)(r.ga)(r.gb); }
  Content& operator()(const Plotel& r) { return (*this)(r.id)(r.ga)(r.gb); }
  Content& operator()(const GridComponents& r) { return (*this)(r.g)(r.c); }
  Content& operator()(const Rbe1& r) { return (*this)(r.id)(r.independent)(r.dependent); }
  Content& operator()(const DirectMatrix::Entry& r) { return (*this)(r.gj)(r.cj)(r.gi)(r.ci)(r.value)(r.imaginary); }
  Content& operator()(const DirectMatrix& r) { return (*this)(r.name)(r.form)(r.is_complex)(r.entries); }
  Content& operator()(const std::pair<double, std::string>& r) { return (*this)(r.first)(r.second); }
  Content& operator()(const Psolid& r) { return (*this)(r.id)(r.mid)(r.cordm); }
  Content& operator()(const BeamElement& r) {
    (*this)(r.id)(r.pid)(r.ga)(r.gb)(r.is_cbeam)(r.g0)(r.v)(r.offt)(r.pin_a)(r.pin_b);
    return (*this)(r.wa)(r.wb)(r.sa)(r.sb);
  }
  Content& operator()(const Crod& r) { return (*this)(r.id)(r.pid)(r.ga)(r.gb); }
  Content& operator()(const Ctube& r) { return (*this)(r.id)(r.pid)(r.ga)(r.gb); }
  Content& operator()(const Conrod& r) { return (*this)(r.id)(r.ga)(r.gb)(r.mid)(r.A)(r.J)(r.c)(r.nsm); }
  Content& operator()(const ScalarSpring& r) {
    return (*this)(r.id)(r.pid)(r.k)(r.ge)(r.s)(r.g1)(r.c1)(r.g2)(r.c2)(r.by_scalar_points);
  }
  Content& operator()(const ScalarMass& r) {
    return (*this)(r.id)(r.pid)(r.m)(r.g1)(r.c1)(r.g2)(r.c2)(r.by_scalar_points);
  }
  Content& operator()(const Cbush& r) {
    return (*this)(r.id)(r.pid)(r.ga)(r.gb)(r.g0)(r.v)(r.cid)(r.s)(r.ocid)(r.s_offset);
  }
  Content& operator()(const Conm1& r) { return (*this)(r.id)(r.g)(r.cid)(r.m); }
  Content& operator()(const Conm2& r) { return (*this)(r.id)(r.g)(r.cid)(r.m)(r.x)(r.inertia); }
  Content& operator()(const ShellElement& r) {
    (*this)(r.card)(r.id)(r.pid)(r.grids)(r.midsides)(r.theta_deg)(r.mcid)(r.z_offset);
    return (*this)(r.relative_thickness)(r.t);
  }
  Content& operator()(const SolidElement& r) { return (*this)(r.card)(r.id)(r.pid)(r.corners)(r.midsides); }
  Content& operator()(const Rbe2& r) { return (*this)(r.id)(r.gn)(r.cm)(r.gm); }
  Content& operator()(const Rbe3::Group& r) { return (*this)(r.weight)(r.c)(r.grids); }
  Content& operator()(const Rbe3::Dependent& r) { return (*this)(r.g)(r.c); }
  Content& operator()(const Rbe3& r) { return (*this)(r.id)(r.ref_grid)(r.ref_c)(r.groups)(r.um); }
  Content& operator()(const Rbar& r) { return (*this)(r.id)(r.ga)(r.gb)(r.cna)(r.cnb)(r.cma)(r.cmb); }
  Content& operator()(const Rrod& r) { return (*this)(r.id)(r.ga)(r.gb)(r.cma)(r.cmb); }
  Content& operator()(const Spc& r) { return (*this)(r.sid)(r.g)(r.c)(r.d); }
  Content& operator()(const SetUnion& r) { return (*this)(r.sid)(r.sets); }
  Content& operator()(const MpcTerm& r) { return (*this)(r.g)(r.c)(r.a); }
  Content& operator()(const Mpc& r) { return (*this)(r.sid)(r.terms); }
  Content& operator()(const PointLoad& r) { return (*this)(r.sid)(r.g)(r.cid)(r.f)(r.n)(r.is_moment); }
  Content& operator()(const Gravity& r) { return (*this)(r.sid)(r.cid)(r.a)(r.n); }
  Content& operator()(const std::pair<double, int>& r) { return (*this)(r.first)(r.second); }
  Content& operator()(const LoadCombination& r) { return (*this)(r.sid)(r.s)(r.terms); }
  Content& operator()(const DirectedLoad& r) { return (*this)(r.sid)(r.g)(r.f)(r.grids)(r.is_cross)(r.is_moment); }
  Content& operator()(const BeamLoad& r) {
    (*this)(r.sid)(r.element)(r.is_moment)(r.axis)(r.in_element_axes)(r.is_fraction)(r.is_projected);
    return (*this)(r.x1)(r.p1)(r.x2)(r.p2);
  }
  Content& operator()(const GridPressure& r) { return (*this)(r.sid)(r.p)(r.grids); }
  Content& operator()(const ElementPressure& r) {
    return (*this)(r.sid)(r.element)(r.p)(r.g1)(r.g34)(r.cid)(r.n)(r.skip_if_missing);
  }
  Content& operator()(const Rotation& r) { return (*this)(r.sid)(r.g)(r.cid)(r.a)(r.r)(r.racc); }
  Content& operator()(const Spcd& r) { return (*this)(r.sid)(r.g)(r.c)(r.d); }
  Content& operator()(const ScalarLoad& r) { return (*this)(r.sid)(r.point)(r.f); }
  Content& operator()(const EigenMethod& r) {
    (*this)(r.sid)(r.is_eigrl)(r.method)(r.f1)(r.f2)(r.num_modes)(r.norm);
    return (*this)(r.norm_grid)(r.norm_component);
  }
  Content& operator()(const std::pair<int, int>& r) { return (*this)(r.first)(r.second); }
  Content& operator()(const std::pair<double, double>& r) { return (*this)(r.first)(r.second); }
  Content& operator()(const std::pair<int, std::vector<int>>& r) { return (*this)(r.first)(r.second); }
  Content& operator()(const Pbcomp::Lump& r) { return (*this)(r.r)(r.fraction)(r.mid); }
  Content& operator()(const Pbcomp& r) {
    (*this)(r.id)(r.mid)(r.A)(r.I1)(r.I2)(r.I12)(r.J)(r.nsm)(r.k1)(r.k2);
    return (*this)(r.m)(r.n)(r.section)(r.lumps);
  }
  Content& operator()(const GridComponent& r) { return (*this)(r.g)(r.c); }
  Content& operator()(const Genel& r) { return (*this)(r.id)(r.ui)(r.ud)(r.is_flexibility)(r.matrix)(r.s); }
  Content& operator()(const Cbend& r) { return (*this)(r.id)(r.pid)(r.ga)(r.gb)(r.g0)(r.v)(r.geom); }
  Content& operator()(const Pbend& r) {
    (*this)(r.id)(r.mid)(r.A)(r.I1)(r.I2)(r.J)(r.k1)(r.k2)(r.rb)(r.theta_b_deg)(r.nsm)(r.rc)(r.zc);
    return (*this)(r.delta_n)(r.is_pipe)(r.fsi)(r.rm)(r.t)(r.pressure);
  }
  Content& operator()(const Cfast& r) {
    return (*this)(r.id)(r.pid)(r.by_elements)(r.ida)(r.idb)(r.gs)(r.ga)(r.gb)(r.xs);
  }
  Content& operator()(const Pfast& r) {
    (*this)(r.id)(r.d)(r.mcid)(r.mflag)(r.mass)(r.ge);
    for (const double k : r.kt) (*this)(k);
    for (const double k : r.kr) (*this)(k);
    return *this;
  }
  Content& operator()(const Cweld& r) {
    (*this)(r.id)(r.pid)(r.format)(r.gs)(r.ga)(r.gb)(r.types)(r.ida)(r.idb);
    return (*this)(r.grids_a)(r.grids_b)(r.xs);
  }
  Content& operator()(const Pweld& r) { return (*this)(r.id)(r.mid)(r.d)(r.is_spot)(r.ld_min)(r.ld_max); }
  Content& operator()(const MaterialTables& r) { return (*this)(r.material)(r.mid)(r.tables); }
  Content& operator()(const FunctionTable& r) {
    (*this)(r.id)(r.kind)(r.is_log_x)(r.is_log_y)(r.is_flat)(r.x1)(r.x2)(r.x3)(r.x4);
    return (*this)(r.points)(r.coefficients);
  }
  Content& operator()(const Cgap& r) { return (*this)(r.id)(r.pid)(r.ga)(r.gb)(r.g0)(r.v)(r.cid); }
  Content& operator()(const Pgap& r) { return (*this)(r.id)(r.u0)(r.f0)(r.ka)(r.kb)(r.kt); }
  Content& operator()(const NonstructuralMass& r) {
    return (*this)(r.sid)(r.type)(r.is_total)(r.is_all)(r.range)(r.value);
  }
  Content& operator()(const Rspline::Point& r) { return (*this)(r.g)(r.c); }
  Content& operator()(const Rspline& r) { return (*this)(r.id)(r.ratio)(r.points); }
  Content& operator()(const GridAcceleration& r) {
    (*this)(r.sid)(r.cid)(r.a)(r.n)(r.is_all)(r.grids)(r.skip_if_missing);
    return (*this)(r.direction)(r.table);
  }
  Content& operator()(const Param& r) { return (*this)(r.name)(r.value); }
  Content& operator()(const Subcase& r) {
    (*this)(r.id)(r.title)(r.subtitle)(r.label)(r.spc)(r.mpc)(r.load)(r.method)(r.statsub)(r.preload)(r.temperature);
    (*this)(r.initial_temperature)(r.material_temperature);
    return (*this)(r.suport1)(r.nsm)(r.k2gg)(r.m2gg)(r.b2gg);
  }

  Content& operator()(const DynamicLoad& r) {
    (*this)(static_cast<int>(r.kind))(static_cast<int>(r.excitation))(r.sid)(r.excite)(r.delay_set)(r.phase_set);
    (*this)(r.delay)(r.phase_deg)(r.table_a)(r.table_b)(r.a)(r.b);
    return (*this)(r.t1)(r.t2)(r.frequency_hz)(r.growth)(r.power);
  }
  Content& operator()(const DynamicLoadSum& r) { return (*this)(r.sid)(r.s)(r.terms); }
  Content& operator()(const DofValue& r) { return (*this)(r.sid)(r.g)(r.c)(r.value); }
  Content& operator()(const StaticExcitation& r) { return (*this)(r.sid)(r.excite)(r.load)(r.temperature); }
  Content& operator()(const InitialMotion& r) { return (*this)(r.sid)(r.g)(r.c)(r.u0)(r.v0); }
  Content& operator()(const FrequencyTables& r) { return (*this)(r.property)(r.pid)(r.k)(r.b)(r.ge); }
  Content& operator()(const DampingCurve& r) { return (*this)(r.id)(r.type)(r.points); }
  Content& operator()(const FrequencyList& r) {
    return (*this)(r.sid)(r.kind)(r.values)(r.f1)(r.f2)(r.count)(r.is_log)(r.spread);
  }
  Content& operator()(const TimeSteps::Part& r) { return (*this)(r.count)(r.step)(r.every); }
  Content& operator()(const TimeSteps& r) { return (*this)(r.sid)(r.parts); }
  Content& operator()(const SpectralTerm& r) { return (*this)(r.sid)(r.j)(r.k)(r.x)(r.y)(r.table); }
  Content& operator()(const GustSpectrum& r) { return (*this)(r.id)(r.is_dryden)(r.length_over_speed)(r.rms); }
  Content& operator()(const TimeLags& r) { return (*this)(r.sid)(r.count)(r.first)(r.last); }
  Content& operator()(const CrossRequest::Output& r) { return (*this)(r.quantity)(r.id)(r.component); }
  Content& operator()(const CrossRequest& r) { return (*this)(r.sid)(r.a)(r.b)(r.curve); }
  Content& operator()(const ResidualDofs& r) { return (*this)(r.first)(r.last)(r.components); }
  Content& operator()(const ComplexMethod::Shift& r) { return (*this)(r.alpha)(r.omega)(r.num_modes); }
  Content& operator()(const ComplexMethod& r) {
    return (*this)(r.sid)(r.method)(r.norm)(r.norm_grid)(r.norm_component)(r.num_modes)(r.shifts);
  }
  Content& operator()(const TransferFunction::Term& r) { return (*this)(r.g)(r.c)(r.a0)(r.a1)(r.a2); }
  Content& operator()(const TransferFunction& r) { return (*this)(r.sid)(r.of)(r.terms); }
  Content& operator()(const RotorLine::Range& r) { return (*this)(r.first)(r.last)(r.step)(r.is_thru); }
  Content& operator()(const RotorLine& r) { return (*this)(r.id)(r.grids); }
  Content& operator()(const RotorSpin& r) {
    (*this)(r.rotor)(r.grid_a)(r.grid_b)(r.unit)(r.table)(r.rate)(r.gr)(r.alpha1)(r.alpha2);
    return (*this)(r.wr3)(r.wr4);
  }
  Content& operator()(const RotorAnalysis& r) {
    return (*this)(r.sid)(r.reference)(r.is_synchronous)(r.unit)(r.low)(r.high)(r.speeds)(r.speed);
  }
  Content& operator()(const SpeedList& r) { return (*this)(r.sid)(r.count)(r.first)(r.step); }
  Content& operator()(const ValueList& r) { return (*this)(r.id)(r.values); }
  Content& operator()(const RotorSweepCard::Rotor& r) {
    return (*this)(r.id)(r.line)(r.speed)(r.cid)(r.is_rotating)(r.has_stress)(r.w3)(r.w4);
  }
  Content& operator()(const RotorSweepCard& r) {
    return (*this)(r.sid)(r.count)(r.first)(r.step)(r.shapes_at)(r.rotors);
  }
  Content& operator()(const Unbalance& r) {
    (*this)(r.sid)(r.grid)(r.mass)(r.radius)(r.offset)(r.mass_table)(r.radius_table)(r.offset_table);
    return (*this)(r.x[0])(r.x[1])(r.x[2])(r.angle_deg)(r.from_hz)(r.to_hz);
  }
  Content& operator()(const CaseSet::Range& r) { return (*this)(r.first)(r.last)(r.is_excluded); }
  Content& operator()(const CaseSet& r) { return (*this)(r.is_all)(r.ranges); }
  Content& operator()(const OutputRequest& r) {
    return (*this)(r.is_all)(r.is_none)(r.set)(r.is_phase)(r.is_punched)(r.is_printed);
  }
  template <class Key, class T>
  Content& operator()(const std::map<Key, T>& values) {
    for (const auto& [key, value] : values) (*this)(key)(value);
    return *this;
  }
  Content& operator()(const DynamicSelection& r) {
    (*this)(r.dload)(r.loadset)(r.frequency)(r.tstep)(r.ic)(r.sdamping)(r.cmethod)(r.tfl)(r.ofreq)(r.random)(r.rcross);
    (*this)(r.rgyro)(r.rmethod)(r.k2pp)(r.m2pp)(r.b2pp)(r.resvec)(r.effective_mass_grid);
    return (*this)(r.outputs)(r.sets);
  }
  Content& operator()(const CaseCombination& r) {
    (*this)(r.control.id)(r.control.title)(r.control.subtitle)(r.control.label)(r.command)(r.terms);
    return (*this)(r.selection.outputs);
  }
  Content& operator()(const Sebulk& r) { return (*this)(r.id)(r.type)(r.reference)(r.is_auto)(r.tolerance)(r.unit); }
  Content& operator()(const Seconct& r) { return (*this)(r.a)(r.b)(r.tolerance)(r.points); }
  Content& operator()(const Seload& r) { return (*this)(r.set)(r.superelement)(r.load); }
  Content& operator()(const ExteriorPoint& r) { return (*this)(r.id)(r.c); }
  Content& operator()(const RecoveryItem& r) { return (*this)(r.type)(r.id)(r.num_rows)(r.first_row); }
  Content& operator()(const RecoveryRows& r) { return (*this)(r.name)(r.items); }

  std::vector<double> numbers;
  std::string words;
};

template <class Record>
void compare(const char* what, const std::vector<Record>& a, const std::vector<Record>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Content x = Content()(a[i]), y = Content()(b[i]);
    ASSERT_EQ(x.words, y.words) << what << ' ' << i;
    ASSERT_EQ(x.numbers.size(), y.numbers.size()) << what << ' ' << i;
    for (std::size_t k = 0; k < x.numbers.size(); ++k)
      ASSERT_LE(std::abs(x.numbers[k] - y.numbers[k]), tolerance * std::abs(x.numbers[k]))
          << what << ' ' << x.words << "number " << k << ": " << x.numbers[k] << " and " << y.numbers[k];
  }
}

/// One record, as the only one of a list.
template <class Record>
void compare_one(const char* what, const Record& a, const Record& b, double tolerance) {
  compare(what, std::vector<Record>{a}, std::vector<Record>{b}, tolerance);
}

void compare_superelements(const SuperelementCards& a, const SuperelementCards& b, double tolerance) {
  compare("sebulk", a.sebulk, b.sebulk, tolerance);
  compare("seconct", a.seconct, b.seconct, tolerance);
  compare("seload", a.seload, b.seload, tolerance);
  compare("extrn", a.extrn, b.extrn, tolerance);
  compare("rows", a.rows, b.rows, tolerance);
  EXPECT_EQ(a.load_columns, b.load_columns);
  ASSERT_EQ(a.input4.size(), b.input4.size());
  for (const auto& [unit, file] : a.input4) {
    ASSERT_EQ(b.input4.count(unit), 1u);
    EXPECT_EQ(b.input4.at(unit).path, file.path);
  }
  ASSERT_EQ(a.output.has_value(), b.output.has_value());
  if (a.output) EXPECT_EQ(std::pair(a.output->id, a.output->unit), std::pair(b.output->id, b.output->unit));
  ASSERT_EQ(a.sections.size(), b.sections.size());
  for (std::size_t i = 0; i < a.sections.size(); ++i) {
    EXPECT_EQ(a.sections[i].id, b.sections[i].id);
    expect_equal_decks(*a.sections[i].deck, *b.sections[i].deck, tolerance);
  }
}

}  // namespace

void expect_equal_dynamics(const WholeDeck& a, const WholeDeck& b, double tolerance) {
  expect_equal_decks(a, b, tolerance);
#define BOUGH_COMPARE(member) compare(#member, a.dynamics.member, b.dynamics.member, tolerance)
  BOUGH_COMPARE(loads);
  BOUGH_COMPARE(sums);
  BOUGH_COMPARE(areas);
  BOUGH_COMPARE(delays);
  BOUGH_COMPARE(phases);
  BOUGH_COMPARE(lseq);
  BOUGH_COMPARE(initial);
  BOUGH_COMPARE(tables);
  BOUGH_COMPARE(damping);
  BOUGH_COMPARE(frequencies);
  BOUGH_COMPARE(steps);
  BOUGH_COMPARE(spectral_terms);
  BOUGH_COMPARE(spectra);
  BOUGH_COMPARE(gust_spectra);
  BOUGH_COMPARE(frequency_tables);
  BOUGH_COMPARE(lags);
  BOUGH_COMPARE(crosses);
  BOUGH_COMPARE(residual_dofs);
  BOUGH_COMPARE(complex_methods);
  BOUGH_COMPARE(transfer_functions);
  BOUGH_COMPARE(rotors.lines);
  BOUGH_COMPARE(rotors.spins);
  BOUGH_COMPARE(rotors.analyses);
  BOUGH_COMPARE(rotors.speeds);
  BOUGH_COMPARE(rotors.values);
  BOUGH_COMPARE(rotors.sweeps);
  BOUGH_COMPARE(rotors.unbalances);
#undef BOUGH_COMPARE
  EXPECT_EQ(a.dynamics.extra_points, b.dynamics.extra_points);
  compare("combinations", a.combinations, b.combinations, tolerance);
  if (!a.selections.empty()) {  // bulk data alone has none
    ASSERT_EQ(a.selections.size(), b.selections.size());
  }
  for (const auto& [id, selection] : a.selections) {
    ASSERT_EQ(b.selections.count(id), 1u) << id;
    compare_one("selection", selection, b.selections.at(id), tolerance);
  }
}

void expect_equal_decks(const Deck& a, const Deck& b, double tolerance) {
  EXPECT_EQ(a.sol, b.sol);
  EXPECT_EQ(a.system_cells, b.system_cells);
#define BOUGH_COMPARE(member) compare(#member, a.member, b.member, tolerance)
  BOUGH_COMPARE(subcases);
  BOUGH_COMPARE(grids);
  BOUGH_COMPARE(coord_systems);
  BOUGH_COMPARE(mat1);
  BOUGH_COMPARE(mat2);
  BOUGH_COMPARE(mat8);
  BOUGH_COMPARE(mat9);
  BOUGH_COMPARE(pbar);
  BOUGH_COMPARE(pbarl);
  BOUGH_COMPARE(pbeam);
  BOUGH_COMPARE(pbeaml);
  BOUGH_COMPARE(prod);
  BOUGH_COMPARE(ptube);
  BOUGH_COMPARE(pelas);
  BOUGH_COMPARE(pbush);
  BOUGH_COMPARE(pmass);
  BOUGH_COMPARE(pshell);
  BOUGH_COMPARE(pcomp);
  BOUGH_COMPARE(psolid);
  BOUGH_COMPARE(pshear);
  BOUGH_COMPARE(shear_panels);
  BOUGH_COMPARE(pbush1d);
  BOUGH_COMPARE(cbush1d);
  BOUGH_COMPARE(pdamp);
  BOUGH_COMPARE(dampers);
  BOUGH_COMPARE(pvisc);
  BOUGH_COMPARE(cvisc);
  BOUGH_COMPARE(plotel);
  BOUGH_COMPARE(beams);
  BOUGH_COMPARE(crod);
  BOUGH_COMPARE(conrod);
  BOUGH_COMPARE(ctube);
  BOUGH_COMPARE(springs);
  BOUGH_COMPARE(cbush);
  BOUGH_COMPARE(shells);
  BOUGH_COMPARE(solids);
  BOUGH_COMPARE(scalar_masses);
  BOUGH_COMPARE(conm1);
  BOUGH_COMPARE(conm2);
  BOUGH_COMPARE(rbe2);
  BOUGH_COMPARE(rbe3);
  BOUGH_COMPARE(rbar);
  BOUGH_COMPARE(rrod);
  BOUGH_COMPARE(rbe1);
  BOUGH_COMPARE(direct_matrices);
  BOUGH_COMPARE(suport);
  BOUGH_COMPARE(aset);
  BOUGH_COMPARE(qset);
  BOUGH_COMPARE(bset);
  BOUGH_COMPARE(cset);
  BOUGH_COMPARE(bset);
  BOUGH_COMPARE(cset);
  BOUGH_COMPARE(omit);
  BOUGH_COMPARE(spc);
  BOUGH_COMPARE(spcadd);
  BOUGH_COMPARE(mpc);
  BOUGH_COMPARE(mpcadd);
  BOUGH_COMPARE(point_loads);
  BOUGH_COMPARE(gravity);
  BOUGH_COMPARE(loads);
  BOUGH_COMPARE(temperatures.grids);
  BOUGH_COMPARE(temperatures.defaults);
  BOUGH_COMPARE(temperatures.bars);
  BOUGH_COMPARE(temperatures.plates);
  BOUGH_COMPARE(load_cards.directed);
  BOUGH_COMPARE(load_cards.beams);
  BOUGH_COMPARE(load_cards.grid_pressures);
  BOUGH_COMPARE(load_cards.pressures);
  BOUGH_COMPARE(load_cards.rotations);
  BOUGH_COMPARE(load_cards.spcd);
  BOUGH_COMPARE(load_cards.scalar);
  BOUGH_COMPARE(special.pbcomp);
  BOUGH_COMPARE(special.genel);
  BOUGH_COMPARE(special.cbend);
  BOUGH_COMPARE(special.pbend);
  BOUGH_COMPARE(special.cgap);
  BOUGH_COMPARE(special.pgap);
  BOUGH_COMPARE(special.cfast);
  BOUGH_COMPARE(special.pfast);
  BOUGH_COMPARE(special.cweld);
  BOUGH_COMPARE(special.pweld);
  BOUGH_COMPARE(temperatures.materials);
  BOUGH_COMPARE(temperatures.tables);
  BOUGH_COMPARE(special.nsm);
  BOUGH_COMPARE(special.nsmadd);
  BOUGH_COMPARE(special.rspline);
  BOUGH_COMPARE(special.accelerations);
  BOUGH_COMPARE(eigen_methods);
  BOUGH_COMPARE(params);
#undef BOUGH_COMPARE
  ASSERT_EQ(a.suport1.size(), b.suport1.size());
  for (const auto& [sid, terms] : a.suport1) {
    ASSERT_EQ(b.suport1.count(sid), 1u);
    compare("suport1", terms, b.suport1.at(sid), tolerance);
  }
  EXPECT_EQ(std::set<int>(a.scalar_points.begin(), a.scalar_points.end()),
            std::set<int>(b.scalar_points.begin(), b.scalar_points.end()));
  compare_one("autospc_command", a.autospc_command, b.autospc_command, tolerance);
  compare_superelements(a.super, b.super, tolerance);
}

std::vector<std::string> list_decks() {
  std::vector<std::string> paths;
  for (const auto& folder : {std::filesystem::path(BOUGH_SOURCE_DIR) / "data/examples",
                             std::filesystem::path(BOUGH_SHARED_DIR) / "models"}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".bdf" || entry.path().extension() == ".dat")
        paths.push_back(entry.path().string());
  }
  return paths;
}

}  // namespace bough::nastran
