#pragma once
/// \file Drawing of a deck before any model is built from it: elements, masses, rigid elements, constraints, loads.
#include <map>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "analysis/picture/line_sections.hpp"
#include "formats/records/deck.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::analysis {

/// Elements, points and symbols of a deck; positions [L] in basic. Elements and cards that name a missing grid are left
/// out: `check` reports them.
struct DeckPicture {
  struct Element {
    int id = 0, property = 0;  ///< property 0: the card has none
    std::string card;
    records::CardLocation at;
  };
  /// CONM1, CONM2, CMASSi.
  struct Mass {
    int id = 0, grid = 0;
    std::string card;
    double mass = 0;  ///< [M]
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    records::CardLocation at;
  };
  /// Rigid and interpolation elements: lines from one grid to the others.
  struct Spider {
    int id = 0, centre = 0;
    std::string card;
    std::vector<int> grids;
    records::CardLocation at;
  };
  struct Support {
    int grid = 0, set = 0;  ///< set 0: permanent constraint of the GRID card
    unsigned components = 0;
  };
  struct Load {
    int grid = 0, set = 0;
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();  ///< [F] or [F L], in basic
    bool is_moment = false;
  };
  struct System {
    int id = 0;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, in basic
  };
  /// A property or material card with its main values.
  struct Property {
    std::string card, values;
    int id = 0;
    records::CardLocation at;
  };

  records::BodyMesh mesh;                    ///< all grids; blocks of line2, tri3, quad4, tetra4, penta6, hexa8
  std::vector<Element> elements;             ///< in the order of the blocks and of their rows
  std::vector<records::CardLocation> grids;  ///< card of each grid of the mesh
  std::vector<int> part;                     ///< [grid] number of its connected part, 0 the largest; -1: in no element
  int num_parts = 0;
  std::vector<Mass> masses;
  std::vector<Spider> spiders;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<System> systems;
  std::vector<Property> properties;
  LineSections line_sections;
};

/// Messages about coordinate systems are added to `diagnostics`; nothing is thrown. O(elements log elements).
DeckPicture make_deck_picture(const records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::analysis
