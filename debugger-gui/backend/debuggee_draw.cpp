// What the window asks of the whole draw.
#include <algorithm>

#include "debugger-gui/backend/debuggee.h"
#include "debugger-gui/backend/thumbnail.h"
#include "profiler/profile_files.h"

namespace shadestep::gui {

using session::Error;
using session::Outcome;

namespace {

// Another stage is selected for a while.
class OtherStage {
 public:
  OtherStage(session::Session& session, session::Stage stage) : session_(session), before_(session.stage()) {
    session_.select(stage);
  }
  OtherStage(const OtherStage&) = delete;
  OtherStage& operator=(const OtherStage&) = delete;
  ~OtherStage() { session_.select(before_); }

 private:
  session::Session& session_;
  const session::Stage before_;
};

}  // namespace

OriginPtr Debuggee::origin(Pixel pixel, session::Stage stage) {
  session::Session& session = atDraw();
  const OtherStage meanwhile(session, stage);
  return std::make_shared<session::FragmentOrigin>(session::originOf(session, pixel.x, pixel.y, stage));
}

EmitsPtr Debuggee::emits() {
  session::Session& session = atDraw();
  const OtherStage meanwhile(session, session::Stage::geometry);
  return std::make_shared<session::GeometryEmits>(session::geometryEmits(session));
}

void Debuggee::chooseFragments(const session::FragmentChoice& choice) {
  atDraw().choose(choice);
  fragments_ = choice;
  stepper_.reset();
}

// Nothing where the draw leaves no picture that can be looked at.
TargetPtr Debuggee::drawnTarget(bool compare) {
  session::Session& session = atDraw();
  if (!whyNot(session::Stage::fragment).empty()) return nullptr;
  const OtherStage meanwhile(session, session::Stage::fragment);
  session::ExecuteOptions options;
  options.compare = compare;
  options.read_outputs = true;
  options.read_captures = false;
  session::Execution execution = session.execute(session.prepareOriginal(), options);
  auto target = std::make_shared<TargetView>();
  target->width = session.facts().width;
  target->height = session.facts().height;
  target->check = execution.check;
  target->outputs = std::move(execution.outputs);
  return target;
}

TargetPtr Debuggee::target() {
  return drawnTarget(true);
}

QImage Debuggee::thumbnail() {
  try {
    const TargetPtr drawn = drawnTarget(false);
    if (drawn && !drawn->outputs.empty())
      return thumbnailOf(drawn->outputs.front(), drawn->width, drawn->height);
  } catch (const Error& error) {
    if (error.outcome() == Outcome::ended) throw;
  }
  return {};
}

LoopsPtr Debuggee::loops() {
  return std::make_shared<session::LoopsReport>(session::profileLoops(atDraw()));
}

ProfilePtr Debuggee::profile(const CostRequest& request, const std::function<void(double)>& progress) {
  session::Session& session = atDraw();
  session.requireCapturable();
  std::optional<profiler::Earlier> earlier;
  if (!request.compare_to.empty()) earlier = profiler::readEarlier(request.compare_to);
  profiler::ProfileOptions options;
  options.budget = request.budget;
  options.progress = progress;
  options.stop = [this] { return cancelled_.load(); };
  auto view = std::make_shared<ProfileView>();
  const std::string method = earlier && request.method == "auto" ? earlier->method : request.method;
  view->profile = profiler::profileBy(method, session, options);
  view->source = session.shader().lines;
  view->subject = profiler::subjectOf(launch_.command.front(), session);
  if (earlier) view->comparison = profiler::compare(*earlier, view->profile, view->source);
  return view;
}

TextureListPtr Debuggee::textures() {
  return std::make_shared<std::vector<session::ShaderTexture>>(session::shaderTextures(atDraw()));
}

TexturePtr Debuggee::texture(const std::string& uniform, int level, int slice) {
  return std::make_shared<session::TextureImage>(session::textureImage(atDraw(), uniform, level, slice));
}

BufferListPtr Debuggee::buffers() {
  return std::make_shared<std::vector<session::BoundBuffer>>(atDraw().buffers());
}

BufferPtr Debuggee::buffer(const session::BoundBuffer& bound) {
  return std::make_shared<BufferView>(BufferView{session::bufferContents(atDraw(), bound), bound});
}

GlState Debuggee::glState() {
  return atDraw().glState();
}

}  // namespace shadestep::gui
