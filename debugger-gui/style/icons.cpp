#include "debugger-gui/style/icons.h"

#include <QIconEngine>
#include <QMap>
#include <QPainter>
#include <QSvgRenderer>

#include "debugger-gui/style/theme.h"

namespace shadestep::gui {
namespace {

// On a field of 20 x 20; 'I' stands for the ink, 'A' for the accent, 'G' good, 'B' bad, 'N' neutral.
const QMap<QString, QString>& drawings() {
  static const QMap<QString, QString> kDrawings = {
      {"start", R"(<path d="M6 4l10 6-10 6z" fill="G" stroke="G"/>)"},
      {"stop", R"(<rect x="5" y="5" width="10" height="10" rx="1.5" fill="B" stroke="B"/>)"},
      {"pause", R"(<path d="M7 5v10M13 5v10" stroke="I" stroke-width="2.600"/>)"},
      {"run", R"(<path d="M4 4v12" stroke="I"/><path d="M8 4.500l8 5.500-8 5.500z" fill="A" stroke="A"/>)"},
      {"run-back",
       R"(<path d="M16 4v12" stroke="I"/><path d="M12 4.500l-8 5.500 8 5.500z" fill="A" stroke="A"/>)"},
      {"over",
       R"(<path d="M3 11a7 7 0 0 1 13-2" stroke="A"/><path d="M16.500 4.500v5h-5" stroke="A"/><circle cx="10" cy="15" r="1.800" fill="I" stroke="none"/>)"},
      {"back",
       R"(<path d="M17 11a7 7 0 0 0-13-2" stroke="A"/><path d="M3.500 4.500v5h5" stroke="A"/><circle cx="10" cy="15" r="1.800" fill="I" stroke="none"/>)"},
      {"into",
       R"(<path d="M10 2.500v9M6.200 8l3.800 3.800L13.800 8" stroke="A"/><circle cx="10" cy="16" r="1.800" fill="I" stroke="none"/>)"},
      {"out",
       R"(<path d="M10 12V3M6.200 6.500L10 2.700l3.800 3.800" stroke="A"/><circle cx="10" cy="16" r="1.800" fill="I" stroke="none"/>)"},
      {"next-draw", R"(<path d="M5 5l5 5-5 5" stroke="I"/><path d="M14 4.500v11" stroke="A"/>)"},
      {"next-frame",
       R"(<rect x="2.500" y="5" width="8" height="10" rx="1" stroke="I"/><path d="M13 10h4.500M15 7.500l2.500 2.500-2.500 2.500" stroke="A"/>)"},
      {"next-iteration",
       R"(<path d="M15.500 10a5.500 5.500 0 1 1-2-4.300" stroke="A"/><path d="M14 2v4h-4" stroke="A"/>)"},
      {"leave-loop",
       R"(<path d="M11 4.600A5.500 5.500 0 1 0 11 15.400" stroke="I"/><path d="M10 10h8M15 7l3 3-3 3" stroke="A"/>)"},
      {"restart",
       R"(<path d="M5 7.500A6 6 0 1 1 4 11" stroke="A"/><path d="M4.500 3.500v4.500h4.500" stroke="A"/>)"},
      {"list",
       R"(<path d="M7 5.500h10M7 10h10M7 14.500h10" stroke="I"/><path d="M3.500 5.500h.1M3.500 10h.1M3.500 14.500h.1" stroke="A" stroke-width="2.200"/>)"},
      {"pictures",
       R"(<rect x="2.500" y="4" width="15" height="12" rx="1" stroke="I"/><path d="M3 14l4.500-5 3.500 4 2-2 4 4" stroke="A"/><circle cx="13" cy="7.500" r="1.200" stroke="A"/>)"},
      {"fit",
       R"(<path d="M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4" stroke="I"/><rect x="7" y="7" width="6" height="6" stroke="A"/>)"},
      {"copy",
       R"(<rect x="7" y="7" width="9" height="10" rx="1" stroke="I"/><path d="M13 4.500V3.500H4v10h1" stroke="I"/>)"},
      {"save",
       R"(<path d="M10 3v9M6.500 8.500L10 12l3.500-3.500" stroke="A"/><path d="M3.500 13v3.500h13V13" stroke="I"/>)"},
      {"open",
       R"(<path d="M2.500 16V4.500h5l2 2h7V9" stroke="I"/><path d="M2.500 16L5 9h13l-2.500 7z" stroke="I"/>)"},
      {"add", R"(<path d="M10 4v12M4 10h12" stroke="A"/>)"},
      {"remove", R"(<path d="M5 5l10 10M15 5L5 15" stroke="I"/>)"},
      {"check",
       R"(<circle cx="10" cy="10" r="7.500" fill="G" stroke="none"/><path d="M6.300 10.300l2.600 2.600 4.900-5.400" stroke="#fff" stroke-width="1.800"/>)"},
      {"differs",
       R"(<circle cx="10" cy="10" r="7.500" fill="B" stroke="none"/><path d="M7 7l6 6M13 7l-6 6" stroke="#fff" stroke-width="1.800"/>)"},
      {"unknown",
       R"(<circle cx="10" cy="10" r="7.500" fill="N" stroke="none"/><path d="M6.500 10h7" stroke="#fff" stroke-width="1.800"/>)"},
      {"app",
       R"(<rect x="1.500" y="1.500" width="17" height="17" rx="4" fill="A" stroke="none"/><path d="M5 14.500h3v-4h3.500v-4H15" stroke="#fff" stroke-width="2"/>)"},
  };
  return kDrawings;
}

QByteArray svgOf(const QString& name, const QColor& ink) {
  QString body = drawings().value(name);
  const auto fill = [&](const char* mark, const QColor& color) {
    body.replace(QString("\"%1\"").arg(mark), QString("\"%1\"").arg(color.name()));
  };
  fill("I", ink);
  fill("A", ink == theme().neutral ? ink : theme().accent);
  fill("G", ink == theme().neutral ? ink : theme().good);
  fill("B", ink == theme().neutral ? ink : theme().bad);
  fill("N", theme().neutral);
  return QString(
             R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20" fill="none" stroke-width="1.600" )"
             R"(stroke-linecap="round" stroke-linejoin="round">%1</svg>)")
      .arg(body)
      .toUtf8();
}

// Drawn when asked for, so that it follows the theme and the screen's resolution.
class LineIcon : public QIconEngine {
 public:
  explicit LineIcon(QString name) : name_(std::move(name)) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State) override {
    QSvgRenderer svg(svgOf(name_, mode == QIcon::Disabled ? theme().neutral : theme().text));
    painter->setOpacity(mode == QIcon::Disabled ? 0.45 : 1);
    svg.render(painter, rect);
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    QPixmap pixmap(size);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    paint(&painter, QRect(QPoint(), size), mode, state);
    return pixmap;
  }
  QIconEngine* clone() const override { return new LineIcon(name_); }

 private:
  QString name_;
};

}  // namespace

QIcon icon(const QString& name) {
  return drawings().contains(name) ? QIcon(new LineIcon(name)) : QIcon();
}

}  // namespace shadestep::gui
