#include "tools/inspect/rows_in_view.h"

#include "core/parallel.h"

namespace bnvpl {

std::vector<RowInView> rowsInView(const VplTable& table, const Accelerator& accel) {
  const Scene& scene = accel.scene();
  std::vector<RowInView> rows(table.size());
  parallelFor(table.size(), 256, [&](size_t i) {
    const Vec3 position = table.position[i];
    const RasterPoint film = projectToFilm(scene.camera, scene.film, position);
    const bool faces = dot(table.normal[i], scene.camera.position - position) > 0.0f;
    const bool inside =
        film.depth > 0.0f && film.x >= 0.0f && film.x <= 1.0f && film.y >= 0.0f && film.y <= 1.0f;
    rows[i] = {film, faces ? RowSight::Outside : RowSight::FacingAway, inside};
    if (!inside) return;
    const Vec3 side = faces ? table.normal[i] : -table.normal[i];
    const bool hidden = accel.occluded(scene.camera.position, accel.offsetOrigin(position, side));
    if (faces)
      rows[i].sight = hidden ? RowSight::Occluded : RowSight::InSight;
    else if (!hidden)
      rows[i].sight = RowSight::BackInSight;
  });
  return rows;
}

}  // namespace bnvpl
