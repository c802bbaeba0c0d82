#include "tools/inspect/scene/scene_report.h"

#include <map>
#include <set>
#include <sstream>

#include "core/files.h"
#include "core/hash.h"
#include "core/sampling.h"
#include "tools/common/options/film_size.h"

namespace bnvpl {

namespace {

Json vectorJson(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

// The point in the coordinates of the files.
Json placeJson(const Scene& scene, Vec3 p) {
  return Json::array({p.x + scene.origin[0], p.y + scene.origin[1], p.z + scene.origin[2]});
}

// Objects and the triangles that they have in the scene, those of an instance once for each.
Json describeObjects(const Scene& scene) {
  std::vector<uint64_t> triangles(scene.objectNames.size()), instances(scene.objectNames.size());
  for (uint32_t t = 0; t < scene.worldEnd(); ++t) ++triangles[scene.objectOf(t)];
  std::vector<std::map<uint32_t, uint64_t>> own(scene.prototypes.size());
  for (size_t p = 0; p < own.size(); ++p) {
    for (uint32_t t = scene.prototypes[p].begin; t < scene.prototypes[p].end; ++t)
      ++own[p][scene.objectOf(t)];
  }
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    std::set<uint32_t> met;
    for (const auto& [object, count] : own[scene.instances[i].prototype]) {
      const uint32_t given = scene.instanceObjects[i];
      const uint32_t here = given == kNone ? object : given;
      triangles[here] += count;
      instances[here] += met.insert(here).second;
    }
  }
  Json list = Json::array();
  for (size_t o = 0; o < triangles.size(); ++o) {
    list.push_back(
        {{"name", scene.objectNames[o]}, {"triangles", triangles[o]}, {"instances", instances[o]}});
  }
  return list;
}

Json describeViews(const Scene& scene) {
  Json list = Json::array();
  for (size_t i = 0; i < scene.views.size(); ++i) {
    const Camera& c = scene.views[i].camera;
    list.push_back({{"number", i},
                    {"name", scene.views[i].name},
                    {"position", placeJson(scene, c.position)},
                    {"forward", vectorJson(c.forward)},
                    {"up", vectorJson(c.up)},
                    {"vertical_fov_deg", c.verticalFovRad * kDegPerRad},
                    {"shift", c.shift},
                    {"film", sizeText(scene.views[i].film)}});
    if (const FilterSpec& filter = scene.views[i].film.filter; filter != FilterSpec{}) {
      list.back()["filter"] = nameOf(filter.kind);
      list.back()["filter_radius"] = filter.radius;
    }
    if (!c.hasLens()) continue;
    list.back()["lens_radius"] = c.lensRadius;
    list.back()["focus_distance"] = c.focusDistance;
  }
  return list;
}

Json describeLights(const Scene& scene, const LightSet& lights) {
  Json list = Json::array();
  for (size_t i = 0; i < lights.size(); ++i) {
    list.push_back({{"light", lights.name(i)}, {"power_W", vectorJson(lights.power(i))}});
    if (scene.lightGroups.size() > 1) list.back()["group"] = scene.lightGroups[lights.group(i)];
  }
  return list;
}

Json describeTextures(const Scene& scene) {
  Json list = Json::array();
  for (size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& t = scene.textures[i];
    list.push_back({{"number", i},
                    {"file", t.name},
                    {"width", t.width},
                    {"height", t.height},
                    {"colour_space", t.srgb ? "sRGB" : "data"}});
  }
  return list;
}

std::string numberText(double number) {
  std::ostringstream text;
  text.precision(4);
  text << number;
  return text.str();
}

std::string valueText(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return numberText(value.get<double>());
  if (!value.is_array()) return jsonText(value);
  std::string list;
  for (const Json& v : value) list += (list.empty() ? "" : " ") + valueText(v);
  return "(" + list + ")";
}

// "NAME VALUE, NAME VALUE" for all members except those in `without`.
std::string membersText(const Json& object, const std::vector<std::string>& without) {
  std::string text;
  for (const auto& [key, value] : object.items()) {
    if (std::find(without.begin(), without.end(), key) != without.end()) continue;
    text += (text.empty() ? "" : ", ") + key + " " + valueText(value);
  }
  return text;
}

std::string named(const std::string& name) { return name.empty() ? "(no name)" : "'" + name + "'"; }

}  // namespace

Json describeScene(const Scene& scene, const LightSet& lights) {
  Json json{{"scene", scene.name()}, {"hash", hashText(scene.contentHash)}};
  json["lengths"] = "the file's unit, called m";
  json["bounds"] = {{"lower", placeJson(scene, scene.bounds.lower)},
                    {"upper", placeJson(scene, scene.bounds.upper)}};
  json["origin"] = scene.origin;
  json["triangles"] = scene.triangles.size();
  json["masked_triangles"] = scene.maskedTriangles();
  json["vertices"] = scene.positions.size() - 1;
  json["meshes"] = Json::array();
  for (const MeshRecord& m : scene.meshes)
    json["meshes"].push_back(
        {{"name", m.name}, {"triangles", m.triangles}, {"instances", m.instances}});
  json["objects"] = describeObjects(scene);
  json["materials"] = Json::array();
  for (const Material& m : scene.materials) json["materials"].push_back(describeMaterial(scene, m));
  json["lights"] = describeLights(scene, lights);
  json["cameras"] = describeViews(scene);
  json["textures"] = describeTextures(scene);
  json["files"] = Json::array();
  for (const fs::path& file : scene.files) {
    if (isRegularFile(file)) json["files"].push_back(file.string());
  }
  json["warnings"] = scene.warnings;
  return json;
}

std::string sceneText(const Json& asFound) {
  const Json d = withEscapedNames(asFound);
  std::ostringstream out;
  const auto section = [&](const char* key, const auto& line) {
    out << key << ": " << d[key].size() << "\n";
    for (const Json& item : d[key]) out << "  " << line(item) << "\n";
  };
  const auto text = [](const Json& item, const char* key) {
    return item[key].template get<std::string>();
  };
  out << text(d, "scene") << ", content " << text(d, "hash") << "\n"
      << "triangles: " << d["triangles"] << " (" << d["masked_triangles"] << " masked), "
      << d["vertices"] << " vertices, from " << valueText(d["bounds"]["lower"]) << " to "
      << valueText(d["bounds"]["upper"]) << " in " << text(d, "lengths") << "\n";
  section("meshes", [&](const Json& m) {
    return text(m, "name") + ": " + jsonText(m["triangles"]) + " triangles" +
           (m["instances"] == 1 ? "" : ", " + jsonText(m["instances"]) + " instances");
  });
  section("objects", [&](const Json& o) {
    return "'" + text(o, "name") + "': " + jsonText(o["triangles"]) + " triangles" +
           (o["instances"] == 0 ? "" : " in " + jsonText(o["instances"]) + " instances");
  });
  section("materials", [&](const Json& m) {
    return named(text(m, "name")) + ": " + text(m, "model") + "; " +
           membersText(m, {"name", "model"});
  });
  section("lights", [&](const Json& l) {
    return text(l, "light") + ": " + valueText(l["power_W"]) + " W" +
           (l.contains("group") ? ", group " + text(l, "group") : "");
  });
  section("cameras", [&](const Json& c) {
    return jsonText(c["number"]) + " " + named(text(c, "name")) + ": " +
           membersText(c, {"number", "name"});
  });
  section("textures", [&](const Json& t) {
    return jsonText(t["number"]) + " " + text(t, "file") + ": " + jsonText(t["width"]) + "x" +
           jsonText(t["height"]) + ", " + text(t, "colour_space");
  });
  out << "ignored, approximated or repaired: " << d["warnings"].size() << "\n";
  for (const Json& w : d["warnings"]) out << "  " << w.get<std::string>() << "\n";
  return out.str();
}

}  // namespace bnvpl
