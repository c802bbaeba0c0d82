// The rows that travel from stage to stage, as columns (structure of arrays).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

enum class VplStage : uint32_t { Candidates = 1, Eliminated = 2, Lit = 3 };

// Owns the columns. Every column of the stage has size() rows; the later stages' columns are empty.
struct VplTable {
  VplStage stage = VplStage::Candidates;

  // since Candidates
  std::vector<Vec3> position;  // world units
  std::vector<Vec3> normal;    // geometric, unit length, on the lit side
  std::vector<Vec3> albedo;    // fraction of incident flux that leaves again, linear sRGB, 0..1
  std::vector<uint32_t> id;    // row in path order at placement; survives every stage

  // since Eliminated
  std::vector<float>
      radius;         // r_max of this VPL, world units: it stands for 2 sqrt(3) radius^2 of surface
  double rMax = 0.0;  // r_max that belongs to areaEstimate (uniform density), world units
  double areaEstimate = 0.0;  // indirectly visible area, world units squared

  // since Lit
  double reach =
      0.0;  // how far each VPL received photons, in units of its radius; 0: placed from lights
  std::vector<Vec3> flux;         // W leaving this VPL's share of the surface, linear sRGB
  std::vector<uint64_t> photons;  // deposits received
  std::vector<float>
      relativeError;               // standard error of the flux over the flux, 0 where photons = 0
  std::vector<Vec3> emitPosition;  // where its light leaves from, near its position; world units
  std::vector<Vec3> emitNormal;    // geometric, unit length, there
  std::vector<Vec3> firstBounceFlux;  // W, the part of flux that came straight from a light

  uint64_t sceneHash = 0;  // content hash of the scene that the rows lie on
  std::string provenance;  // JSON array, oldest stage first; see formats/README.md
  uint64_t checksum = 0;   // of the file that these rows were read from; 0 when they are new

  size_t size() const { return position.size(); }
};

}  // namespace bnvpl
