#pragma once
/// \file Beam models as deck records, made in a few lines: what the tests of modal, stiffening and cases share.
#include <map>
#include <string>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::test {

using Eigen::Vector3d;

struct Section {
  double E = 1, G = 1, rho = 1, A = 1, I1 = 1, I2 = 1, J = 1;
  double shear_factor = 0;  ///< of both planes; 0: Euler-Bernoulli
};

/// The beam of NASA-CR-202063, 4.1.4.1: L = 8 m, mass 1.6154 kg.
inline constexpr double kReportLength = 8;
inline Section get_report_section() {
  return {6.895e10, 6.895e10 / 2.6, 2766.67, 7.2986e-5, 8.2181e-9, 8.2181e-9, 1.64362e-8};
}

class DeckMaker {
 public:
  /// A consistent mass by COUPMASS unless `lumped`.
  explicit DeckMaker(bool lumped = false) {
    deck.files = {"test.bdf"};
    deck.sol = "103";
    records::Subcase subcase;
    subcase.id = 1;
    deck.subcases = {subcase};
    deck.params.push_back({"COUPMASS", lumped ? "-1" : "1", {}});
  }

  /// Property and material `pid`; I1 bends in the element's xy-plane, I2 in its xz-plane.
  void add_section(int pid, const Section& s, bool is_cbeam = false) {
    records::Mat1 mat;
    mat.id = pid;
    mat.E = s.E;
    mat.G = s.G;
    mat.nu = s.E / (2 * s.G) - 1;
    mat.rho = s.rho;
    deck.mat1.push_back(mat);
    if (is_cbeam) {
      records::Pbeam p;
      p.id = p.mid = pid;
      p.k1 = p.k2 = s.shear_factor;
      for (const double x : {0.0, 1.0}) {
        records::PbeamStation station;
        station.x_over_L = x;
        station.A = s.A;
        station.I1 = s.I1;
        station.I2 = s.I2;
        station.J = s.J;
        station.recovery.fill(Eigen::Vector2d::Zero());
        p.stations.push_back(station);
      }
      deck.pbeam.push_back(p);
    } else {
      records::Pbar p;
      p.id = p.mid = pid;
      p.A = s.A;
      p.I1 = s.I1;
      p.I2 = s.I2;
      p.J = s.J;
      if (s.shear_factor > 0) p.k1 = p.k2 = s.shear_factor;
      deck.pbar.push_back(p);
    }
    beam_of_[pid] = is_cbeam;
  }

  void add_grid(int id, const Vector3d& x) {
    records::Grid grid;
    grid.id = id;
    grid.x = x;
    deck.grids.push_back(grid);
  }

  void add_beam(int id, int pid, int ga, int gb, const Vector3d& v) {
    records::BeamElement beam;
    beam.id = id;
    beam.pid = pid;
    beam.ga = ga;
    beam.gb = gb;
    beam.is_cbeam = beam_of_[pid];
    beam.v = v;
    deck.beams.push_back(beam);
  }

  /// A straight line of `count` elements from a to b; grids first_id .. first_id + count. An end that exists already is
  /// reused when its id is given in start_id, end_id.
  void add_line(int pid, int first_id, const Vector3d& a, const Vector3d& b, int count, const Vector3d& v,
                int start_id = 0, int end_id = 0) {
    const auto id_of = [&](int i) {
      if (i == 0 && start_id) return start_id;
      if (i == count && end_id) return end_id;
      return first_id + i;
    };
    for (int i = 0; i <= count; ++i)
      if (id_of(i) == first_id + i) add_grid(first_id + i, a + (b - a) * (static_cast<double>(i) / count));
    for (int i = 0; i < count; ++i) add_beam(first_id + i, pid, id_of(i), id_of(i + 1), v);
  }

  /// Components like 1235 as decimal digits.
  void fix(int grid, int components) {
    records::Spc spc;
    spc.sid = 1;
    spc.g = grid;
    for (; components > 0; components /= 10) spc.c |= 1u << (components % 10 - 1);
    deck.spc.push_back(spc);
    deck.subcases.front().spc = 1;
  }
  void fix_all(int components) {
    for (const auto& grid : deck.grids) fix(grid.id, components);
  }

  void add_mass(int id, int grid, double m, const Vector3d& offset = Vector3d::Zero()) {
    records::Conm2 mass;
    mass.id = id;
    mass.g = grid;
    mass.m = m;
    mass.x = offset;
    deck.conm2.push_back(mass);
  }

  void add_load(int set, int grid, const Vector3d& f, bool is_moment = false) {
    records::PointLoad load;
    load.sid = set;
    load.g = grid;
    load.f = f.norm();
    load.n = f.normalized();
    load.is_moment = is_moment;
    deck.point_loads.push_back(load);
  }

  records::Deck deck;

 private:
  std::map<int, bool> beam_of_;
};

/// A cantilever along x, root grid 1 clamped, tip grid count + 1; element y is body y.
inline DeckMaker make_cantilever(const Section& section, double length, int count, bool lumped = false,
                                 const Vector3d& origin = Vector3d::Zero()) {
  DeckMaker maker(lumped);
  maker.add_section(1, section);
  maker.add_line(1, 1, origin, origin + length * Vector3d::UnitX(), count, Vector3d::UnitY());
  maker.fix(1, 123456);
  return maker;
}

}  // namespace bough::test
