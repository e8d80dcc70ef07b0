#pragma once
/// \file Contents of print files (F06) and OUTPUT2 files, in the order, the axes and the signs of Nastran.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::records {

/// The numbers are Nastran's table codes.
enum class ListedKind {
  Displacement = 1,
  Load = 2,
  SpcForce = 3,
  Eigenvector = 7,
  Velocity = 10,
  Acceleration = 11,
  MpcForce = 39
};

/// Vectors at points in ascending order of their ids, in displacement (CD) axes.
struct ListedVector {
  ListedKind kind = ListedKind::Displacement;
  std::vector<int> id;
  std::vector<bool> is_scalar;
  Eigen::MatrixXd real, imag;  ///< points x 6, of a scalar point the first column; without imag: real
  bool is_phase = false;       ///< imag not empty: they are magnitude and phase in degrees
  bool is_printed = true;      ///< in the f06 too
};

/// Quantity of ListedElements: stresses; strains of plates at their fibres, or of the reference surface with
/// curvatures.
enum class PointTable { Stress, FibreStrain, CurvatureStrain };

/// Forces, stresses or strains of the elements of one card, in ascending order, in Nastran's columns
/// (docs/formats/op2.md).
struct ListedElements {
  std::string card;
  int type = 0;                          ///< Nastran's element type
  std::vector<int> id;                   ///< of each row
  std::vector<std::array<int, 2>> ends;  ///< CBEAM: grids of the ends
  std::vector<int> point;                ///< of each row: the ply, or the corner's grid of a solid (0: the centre)
  Eigen::MatrixXd real;                  ///< rows x columns; no number: left blank
  Eigen::MatrixXd imag;                  ///< of the same size, or empty: real
  bool is_phase = false;                 ///< imag not empty: they are magnitude and phase in degrees
  bool is_printed = true;
  PointTable table = PointTable::Stress;  ///< of stresses and strains

  /// Returns true if the columns are strains.
  bool is_strain() const { return table != PointTable::Stress; }
};

/// Grid point stresses of a SURFACE or VOLUME, by grid in ascending order.
struct ListedGridStresses {
  int id = 0;
  bool is_volume = false;
  int cid = 0;                                   ///< system of the output, 0: basic
  bool is_element_system = false;                ///< SYSTEM ELEMENT: no system
  int axis = 1;                                  ///< SURFACE: x axis of the output, 1 to 3
  std::string normal;                            ///< SURFACE: R, X1, X2, X3
  bool is_reversed = false;                      ///< SURFACE: normal with M
  bool has_direct = true, has_principal = true;  ///< VOLUME
  bool is_printed = true;
  std::vector<int> grid, element;  ///< of each row; element 0: mean of all elements
  std::vector<std::string> fibre;  ///< SURFACE: Z1, Z2, MID of each row
  /// SURFACE: x y xy, angle [deg], major, minor, largest shear, von Mises. VOLUME: xx yy zz xy yz zx, mean pressure,
  /// von Mises, principal a b c, cosines of x to a b c, of y, of z.
  Eigen::MatrixXd values;
};

/// Strain energies of the elements of one card, in ascending order.
struct ListedEnergies {
  std::string card;
  std::vector<int> id;
  Eigen::VectorXd energy;
  double total = 0;  ///< of all elements of the structure
};

/// One force on a grid: of the load, of a constraint (element 0) or of an element; in displacement (CD) axes.
struct ListedGridForce {
  int grid = 0, element = 0;
  std::string source;
  Eigen::Matrix<double, 6, 1> force = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Everything of one subcase, mode, frequency or time.
/// The subcase of a block and its three lines of text.
struct ListedHeading {
  int subcase = 0;  ///< 1 for a deck without SUBCASE
  std::string title, subtitle, label;
};

struct ListedStep : ListedHeading {
  enum class Kind { Static, Mode, Frequency, Time };
  Kind kind = Kind::Static;
  int load_set = 0;
  int mode = 0;
  double eigenvalue = 0, cycles = 0;
  double at = 0;  ///< Hz or time
  std::vector<ListedVector> vectors;
  std::vector<ListedElements> forces, stresses, strains;
  std::vector<ListedEnergies> energies;
  std::vector<ListedGridStresses> grid_stresses;
  std::vector<ListedGridForce> grid_forces;  ///< by grid in ascending order
};

struct ListedRoots : ListedHeading {
  Eigen::VectorXd eigenvalue, mass, stiffness;
  int num_residual = 0;  ///< the last ones: residual vectors
};

/// Modal effective masses: fractions of the whole, or masses about a grid.
struct ListedEffectiveMass {
  int subcase = 0, grid = 0;
  Eigen::VectorXd cycles;
  Eigen::MatrixXd mass;               ///< n x 6
  Eigen::Matrix<double, 6, 1> whole;  ///< of the rigid body about the grid
  Eigen::MatrixXd participation;      ///< n x 6: φᵀ M Φ_R
};

/// Grid point weight generator.
struct ListedWeight {
  int grid = 0;
  Eigen::Matrix<double, 6, 6> MO;
  Eigen::Matrix3d S, cg, I_S, Q;
  Eigen::Vector3d mass, I_Q;
};

/// One quantity of a random response at points in ascending order, in displacement (CD) axes.
struct ListedRandom {
  ListedKind kind = ListedKind::Displacement;
  int subcase = 0;  ///< the first that RANDPS relates
  std::string title, subtitle, label;
  std::vector<int> id;
  std::vector<bool> is_scalar;
  Eigen::VectorXd hz, lags;
  Eigen::MatrixXd rms, crossing_hz;  ///< points x 6
  /// Per point, frequencies x 6, and lags x 6; without RANDT1 no autocorrelation.
  std::vector<Eigen::MatrixXd> psd, cumulative_rms, autocorrelation;
};

struct Listing {
  std::optional<ListedWeight> weight;
  std::vector<ListedRoots> roots;
  std::vector<ListedEffectiveMass> effective_mass;
  std::vector<ListedStep> steps;
  std::vector<ListedRandom> random;
};

}  // namespace bough::records
