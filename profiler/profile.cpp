// The choice among the methods.
#include "profiler/profile.h"

namespace shadestep::profiler {
namespace {

Profile byMethod(const std::string& method, session::Session& session, const ProfileOptions& options) {
  if (method == "count") return profileCount(session, options);
  if (method == "clock") return profileClock(session, options);
  if (method == "isolate") return profileIsolate(session, options);
  return profileAuto(session, options);
}

}  // namespace

Profile profileAuto(session::Session& session, const ProfileOptions& options) {
  std::vector<std::string> reasons;
  for (Profile (*const method)(session::Session&, const ProfileOptions&) : {profileClock, profileIsolate}) {
    try {
      Profile profile = method(session, options);
      profile.notes.insert(profile.notes.end(), reasons.begin(), reasons.end());
      return profile;
    } catch (const session::Error& error) {
      if (error.outcome() != session::Outcome::cannot_debug) throw;
      reasons.push_back(std::string(method == profileClock ? "Not clock: " : "Not isolate: ") + error.what() +
                        ".");
    }
  }
  Profile profile = profileCount(session, options);
  profile.notes.insert(profile.notes.end(), reasons.begin(), reasons.end());
  return profile;
}

// What textures are read is asked first: it takes one draw, and a long measurement must not be lost for its
// refusal.
Profile profileBy(const std::string& method, session::Session& session, const ProfileOptions& options) {
  std::optional<TextureAccesses> textures;
  if (options.textures) textures = mapTextures(session, options.roi);
  Profile profile = byMethod(method, session, options);
  if (textures) profile.check.merge(textures->check);
  profile.textures = std::move(textures);
  return profile;
}

}  // namespace shadestep::profiler
