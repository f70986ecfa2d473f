// What is asked of the whole draw: loops, costs, state, what a geometry shader makes, which fragments count.
#include "debugger-gui/debugger.h"

namespace shadestep::gui {

void Debugger::askLoops() {
  if (program_ != Program::stopped) return;
  backend_.ask(
      tr("Counting iterations"), "loops", [](Debuggee& debuggee) { return debuggee.loops(); },
      [this, stage = stage()](const LoopsPtr& loops) {
        if (stage != picked_.stage) return;  // another one has been chosen meanwhile
        loops_ = loops;
        Q_EMIT loopsChanged();
      });
}

void Debugger::askEmits() {
  if (program_ != Program::stopped) return;
  backend_.ask(
      tr("Reading what the geometry shader makes"), "emits",
      [](Debuggee& debuggee) { return debuggee.emits(); },
      [this](const EmitsPtr& emits) {
        emits_ = emits;
        Q_EMIT emitsChanged();
      });
}

void Debugger::askProfile(const CostRequest& request) {
  if (program_ != Program::stopped) return;
  backend_.ask(
      tr("Measuring costs"), "profile",
      [this, request](Debuggee& debuggee) {
        return debuggee.profile(request, [this](double share) { backend_.report(share); });
      },
      [this, here = std::pair(stop_->draw.stop.frame, stop_->draw.stop.draw)](const ProfilePtr& profile) {
        profile_ = profile;
        profiled_ = here;
        Q_EMIT profileChanged();
      });
}

bool Debugger::profileIsOfThisDraw() const {
  return profile_ && stop_ && profiled_ == std::pair(stop_->draw.stop.frame, stop_->draw.stop.draw);
}

void Debugger::askGlState() {
  if (program_ != Program::stopped) return;
  backend_.ask(
      tr("Reading the GL state"), "state", [](Debuggee& debuggee) { return debuggee.glState(); },
      [this](const GlState& state) {
        gl_state_ = state;
        Q_EMIT glStateChanged();
      });
}

void Debugger::askTextures() {
  if (program_ != Program::stopped) return;
  backend_.ask(
      tr("Looking at the textures"), "textures", [](Debuggee& debuggee) { return debuggee.textures(); },
      [this](const TextureListPtr& textures) {
        textures_ = textures;
        Q_EMIT texturesChanged();
      });
}

void Debugger::askTexture(const QString& sampler, int level, int slice) {
  if (program_ != Program::stopped) return;
  backend_.ask(
      tr("Reading %1").arg(sampler), "texture",
      [sampler = sampler.toStdString(), level, slice](Debuggee& debuggee) {
        return debuggee.texture(sampler, level, slice);
      },
      [this, sampler](const TexturePtr& texture) {
        texture_ = texture;
        show({PictureSource::Kind::texture, sampler, 0});
      });
}

void Debugger::askBuffers() {
  if (program_ != Program::stopped) return;
  backend_.ask(
      tr("Looking at the buffers"), "buffers", [](Debuggee& debuggee) { return debuggee.buffers(); },
      [this](const BufferListPtr& buffers) {
        buffers_ = buffers;
        Q_EMIT buffersChanged();
      });
}

void Debugger::askBuffer(const session::BoundBuffer& bound) {
  if (program_ != Program::stopped) return;
  backend_.ask(
      tr("Reading buffer %1").arg(bound.buffer), "buffer",
      [bound](Debuggee& debuggee) { return debuggee.buffer(bound); },
      [this](const BufferPtr& buffer) {
        buffer_ = buffer;
        Q_EMIT bufferChanged();
      });
}

void Debugger::setFragments(const session::FragmentChoice& choice) {
  if (program_ != Program::stopped || !place_) return;
  const session::Position position = place_->position;
  askPlace(tr("Choosing fragments"), [choice, position](Debuggee& debuggee) {
    debuggee.chooseFragments(choice);
    return debuggee.moveTo(position);
  });
  fragments_ = choice;
  conditions_ = nullptr;  // another fragment may be the visible one
  askTarget();
}

}  // namespace shadestep::gui
