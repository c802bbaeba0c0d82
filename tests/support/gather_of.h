// A gather on its own, for tests at single points.
#pragma once

#include "tests/support/pipeline.h"
#include "tools/render/gather/point_gather.h"

namespace bnvpl::test {

struct GatherOf {
  // Takes `options` like vpl-render; borrows the world and the VPLs. A gather that inspects the
  // film gets no points.
  GatherOf(const World& world, const VplLights& vpls, const Given& options)
      : tree(buildLightTree(vpls, 1)), point(world.accel, vpls, tree) {
    const Values values = resolve(renderSpec(), options);
    const ProgressFn silent;
    gather = methodNamed(gatherMethods(), values[OptionKey<std::string>{"gather"}])
                 .make({world.accel, vpls, tree, 1,
                        [this] {
                          looksAtFilm = true;
                          return FilmPoints{};
                        },
                        silent},
                       values);
  }
  Gathered at(const Bsdf& bsdf) const {
    const Bsdf* const one[] = {&bsdf};
    TileReceivers tile;
    tile.pixels = 1;
    tile.bsdf = one;
    const Vec3 whole(1.0f);
    tile.weight = {&whole, 1};
    std::vector<Gathered> out(1);
    gather.tile(tile, out);
    return out[0];
  }
  bool looksAtFilm = false;
  LightTree tree;
  PointGather point;
  Gather gather;
};

}  // namespace bnvpl::test
