#include "tools/inspect/check/check.h"

#include <algorithm>
#include <set>

#include "core/hash.h"
#include "formats/image/exr_io.h"
#include "formats/vpl/vpl_io.h"
#include "scene/scene_hash.h"
#include "tools/common/files/shell_text.h"
#include "tools/inspect/file_kind.h"

namespace bnvpl {
namespace {

// The name under which a later stage records the checksum of a file of this stage.
const char* inputName(VplStage stage) {
  switch (stage) {
    case VplStage::Candidates:
      return "candidates";
    case VplStage::Eliminated:
      return "vpls";
    case VplStage::Lit:
      return "lit";
  }
  return "";
}

void refuseNonFinite(const fs::path& file, const Image& image) {
  if (const auto bad = findNonFinite(image)) {
    throw InputError(file, "channel " + bad->channel + " is not finite at pixel (" +
                               std::to_string(bad->x) + ", " + std::to_string(bad->y) +
                               "); rerun vpl-render");
  }
}

void refuseTampering(const fs::path& file, const Image& image) {
  const auto found = image.attributes.find(kImageHashAttribute);
  const bool ours = std::ranges::any_of(image.attributes, [](const auto& attribute) {
    return attribute.first.starts_with("bnvpl.");
  });
  if (!ours) return;
  if (found == image.attributes.end())
    throw InputError(file, std::string("its attribute ") + kImageHashAttribute +
                               " is gone, by which changes show: another program changed the "
                               "image; rerun vpl-render");
  if (found->second == hashText(hashImage(image, ExrPixelType::Float))) return;
  throw InputError(file,
                   "pixels or history are not those that vpl-render wrote: another program changed "
                   "them; rerun vpl-render");
}

// Every scene hash in the history must be the file's own.
void settleScene(CheckedFile& checked) {
  for (const StageRecord& record : checked.chain) {
    const auto scene = record.inputs.find("scene");
    if (scene == record.inputs.end()) continue;
    if (checked.scene.empty()) checked.scene = scene->second;
    if (scene->second == checked.scene) continue;
    throw InputError(checked.file, record.tool + " ran on scene " + scene->second +
                                       ", but the file belongs to scene " + checked.scene +
                                       "; rerun " + record.tool);
  }
}

CheckedFile checkVpl(const fs::path& file) {
  const VplTable table = readVpl(file);
  CheckedFile checked;
  checked.file = file;
  checked.what =
      std::string(stageName(table.stage)) + ", " + std::to_string(table.size()) + " rows";
  checked.stage = table.stage;
  checked.checksum = hashText(table.checksum);
  checked.scene = hashText(table.sceneHash);
  checked.chain = parseProvenance(file, table.provenance);
  return checked;
}

// The layer, as --layers names it, that has the channel; empty for the image itself.
std::string layerOf(const std::string& channel) {
  const std::string part = channel.substr(0, channel.find('.'));
  if (part == "R" || part == "G" || part == "B") return {};
  if (part.starts_with("Crypto")) return part.substr(0, part.find_last_not_of("0123456789") + 1);
  return part.starts_with("light_") ? "light_groups" : part;
}

// " --size 640x480 --layers N,direct". The channels, such as "direct.R", tell the layers.
std::string renderOptions(const Image& image) {
  std::string options =
      " --size " + std::to_string(image.width) + "x" + std::to_string(image.height);
  std::set<std::string> layers;
  for (const ImageChannel& channel : image.channels) {
    if (const std::string layer = layerOf(channel.name); !layer.empty()) layers.insert(layer);
  }
  std::string list;
  for (const std::string& layer : layers) list += (list.empty() ? "" : ",") + layer;
  return list.empty() ? options : options + " --layers " + shellWord(list);
}

CheckedFile checkExr(const fs::path& file) {
  const Image image = readExr(file);
  refuseNonFinite(file, image);
  refuseTampering(file, image);
  CheckedFile checked;
  checked.file = file;
  checked.what = "OpenEXR, " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                 " pixels, " + std::to_string(image.channels.size()) + " channels";
  checked.chain = parseProvenance(file, provenanceOf(image));
  checked.film = Film{static_cast<uint32_t>(image.width), static_cast<uint32_t>(image.height)};
  checked.moreOptions = renderOptions(image);
  return checked;
}

// Whether the reader's history names the checksum. Rejection turns lit VPLs into lit VPLs, so that
// the history of an image may name several lit files.
bool wasRead(const CheckedFile& reader, const std::string& checksum) {
  return std::ranges::any_of(reader.chain, [&](const StageRecord& record) {
    return std::ranges::any_of(record.inputs,
                               [&](const auto& in) { return in.second == checksum; });
  });
}

// A given file of the stage of `input` that the reader never read; null if a file has `checksum`.
const CheckedFile* strangerOfStage(std::span<const CheckedFile> files, const std::string& input,
                                   const std::string& checksum, const CheckedFile& reader) {
  const CheckedFile* stranger = nullptr;
  for (const CheckedFile& f : files) {
    if (!f.stage || inputName(*f.stage) != input) continue;
    if (f.checksum == checksum) return nullptr;
    if (stranger == nullptr && !wasRead(reader, f.checksum)) stranger = &f;
  }
  return stranger;
}

void requireOneScene(std::span<const CheckedFile> files) {
  const CheckedFile* first = nullptr;
  for (const CheckedFile& f : files) {
    if (f.scene.empty()) continue;
    if (first == nullptr) first = &f;
    if (f.scene == first->scene) continue;
    throw InputError(f.file, "made from scene " + f.scene + ", but " + first->file.string() +
                                 " from scene " + first->scene +
                                 "; rerun vpl-place and every later stage on one scene");
  }
}

// Placed VPLs can be used for any view.
bool isPlacing(const StageRecord& record) { return record.tool == "vpl-place"; }

// Whether the scene's view is none of those that the stage used. An image may have another size
// than the scene's film.
bool isOfAnotherView(const CheckedFile& file, const StageRecord& record, const Scene& scene) {
  const Film& film = file.film && &record == &file.chain.back() ? *file.film : scene.film;
  const std::string hash = hashText(hashView(scene.camera, film));
  return !record.views.empty() &&
         std::ranges::find(record.views, hash, &StageRecord::View::hash) == record.views.end();
}

}  // namespace

CheckedFile checkFile(const fs::path& file) {
  CheckedFile checked = wholeFileKind(file) == FileKind::Vpl ? checkVpl(file) : checkExr(file);
  settleScene(checked);
  return checked;
}

void checkTogether(std::span<const CheckedFile> files) {
  requireOneScene(files);
  // Records are checked in chain order: the earliest stage that is out of date must be rerun.
  size_t longest = 0;
  for (const CheckedFile& f : files) longest = std::max(longest, f.chain.size());
  for (size_t step = 0; step < longest; ++step) {
    for (const CheckedFile& f : files) {
      if (step >= f.chain.size()) continue;
      for (const auto& [input, checksum] : f.chain[step].inputs) {
        const CheckedFile* other = strangerOfStage(files, input, checksum, f);
        if (other == nullptr) continue;
        const std::string& tool = f.chain[step].tool;
        std::string problem = tool + " read " + input + " ";
        problem.append(checksum).append(", but ").append(other->file.string()).append(" is ");
        problem.append(other->checksum).append("; rerun ").append(tool);
        throw InputError(f.file, problem + " and every later stage");
      }
    }
  }
}

std::string brokenView(const CheckedFile& file, const StageRecord& record, const Scene& scene) {
  if (isPlacing(record) || !isOfAnotherView(file, record, scene)) return {};
  return record.tool + " looked at another view than that of " + scene.name() + " as it is now";
}

std::string placedForAnotherView(std::span<const CheckedFile> files, const Scene& scene) {
  const auto found = std::ranges::find_if(files, [&](const CheckedFile& f) {
    return !f.chain.empty() && isPlacing(f.chain.front()) &&
           isOfAnotherView(f, f.chain.front(), scene);
  });
  return found == files.end() ? std::string() : describeViews(found->chain.front());
}

void checkScene(std::span<const CheckedFile> files, const Scene& scene) {
  const std::string name = scene.name(), sceneHash = hashText(scene.contentHash);
  for (const CheckedFile& f : files) {
    if (f.scene.empty())
      throw InputError(
          f.file, "names no scene in its history, so nobody can tell whether it is of " + name +
                      "; leave it or --scene out");
    if (f.scene != sceneHash)
      throw InputError(f.file, "made from scene " + f.scene + ", but " + name + " is " + sceneHash +
                                   "; rerun vpl-place and every later stage on it");
    for (const StageRecord& record : f.chain) {
      const std::string broken = brokenView(f, record, scene);
      if (!broken.empty())
        throw InputError(f.file, broken + "; rerun " + record.tool + " and every later stage");
    }
  }
}

}  // namespace bnvpl
