// Volumes from files.
#pragma once

#include <optional>
#include <string>

#include "volume.h"

namespace raycaster {

// What a .raw file does not say of itself. Numbers are little-endian, x fastest.
struct RawLayout {
  enum class Type { u8, u16, f32 };
  Eigen::Vector3i size = {0, 0, 0};
  Type type = Type::u8;
};

// By the name's ending: .den (the density files of VolPack: 62 bytes of header, then bytes), .nrrd or .nhdr
// (scalar, three axes, raw, text or gzip encoding, data attached or in one file beside it) or .raw (needs
// `layout`).
//
// Bytes are divided by 255 as OpenGL does it; other types are mapped linearly from their least and greatest
// value to 0..1 (to 0 where they are all the same). The longest edge of the box is 1; voxels are cubes unless
// the file gives their spacing.
//
// Throws std::runtime_error with a sentence for the user; allocates no more than the file's size justifies.
Volume readVolume(const std::string& path, const std::optional<RawLayout>& layout = {});

// The same for a file whose contents are at hand; `path` gives the format and where data beside it lie.
Volume decodeVolume(const std::string& path, const std::string& contents,
                    const std::optional<RawLayout>& layout = {});

// Whether readVolume knows the name's ending.
bool isVolumeFile(const std::string& path);

}  // namespace raycaster
