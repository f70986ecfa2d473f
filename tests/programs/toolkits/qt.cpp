// Qt 6: an OpenGL window. QT_XCB_GL_INTEGRATION=xcb_egl makes it use EGL.
#include <QGuiApplication>
#include <QOpenGLContext>
#include <QOpenGLWindow>
#include <memory>

#include "scene.h"

namespace {

class Window : public QOpenGLWindow {
  void initializeGL() override {
    const auto byName = [this](const char* name) { return context()->getProcAddress(name); };
    scene_ = std::make_unique<toolkits::Scene>(toolkits::load(byName));
  }
  void paintGL() override {
    scene_->draw(frame_);
    if (++frame_ < toolkits::kFrames) return update();
    QCoreApplication::exit(scene_->right() ? 0 : 1);
  }

  int frame_ = 0;
  std::unique_ptr<toolkits::Scene> scene_;
};

}  // namespace

int main(int argc, char** argv) {
  QGuiApplication application(argc, argv);
  Window window;
  window.resize(toolkits::kWidth, toolkits::kHeight);
  window.show();
  return QGuiApplication::exec();
}
