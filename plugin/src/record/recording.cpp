#include "tandem/plugin/recording.h"

#include <charconv>
#include <cstdio>
#include <fstream>
#include <string>
#include <system_error>

namespace tandem {
namespace {

/// Appends numbers and commas to a text.
class Row {
 public:
  explicit Row(std::string& text) : text_(text) {}
  void add(double value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    text_.append(digits, end);
    text_ += ',';
  }
  void add(const Vec3& v) { add(v.x()), add(v.y()), add(v.z()); }
  void add(const Quat& q) { add(q.w()), add(Vec3(q.vec())); }
  void end() { text_.back() = '\n'; }

 private:
  std::string& text_;
};

/// Appends the number of the second and further bodies to a name; the first body has none.
std::string numbered(const char* name, int index) {
  return index == 0 ? std::string(name) : std::string(name) + std::to_string(index + 1);
}

void addVectorHeader(std::string& header, const std::string& name) {
  for (const char* axis : {"_x,", "_y,", "_z,"}) header += name + axis;
}

void addBodyHeader(std::string& header, const char* name, int index) {
  const std::string full = numbered(name, index);
  addVectorHeader(header, full);
  addVectorHeader(header, "body_" + full);
  for (const char* part : {"_qw,", "_qx,", "_qy,", "_qz,"}) header += full + part;
}

}  // namespace

Recording::Recording(std::size_t ticks, std::size_t arrivals, int objects, int proxies)
    : object_count_(objects), proxy_count_(proxies) {
  // Resizing touches the pages, so that no tick has to.
  ticks_.resize(ticks);
  objects_.resize(ticks * static_cast<std::size_t>(objects));
  proxies_.resize(ticks * static_cast<std::size_t>(proxies));
  arrivals_.resize(arrivals);
  ticks_.clear(), objects_.clear(), proxies_.clear(), arrivals_.clear();
}

void Recording::addTick(const TickRecord& record, const BodyRecord* objects,
                        const BodyRecord* proxies) noexcept {
  if (ticks_.size() == ticks_.capacity()) {
    ++left_out_;
    return;
  }
  ticks_.push_back(record);
  objects_.insert(objects_.end(), objects, objects + object_count_);
  proxies_.insert(proxies_.end(), proxies, proxies + proxy_count_);
}

void Recording::addArrival(const ArrivalRecord& record) noexcept {
  if (arrivals_.size() == arrivals_.capacity()) {
    ++left_out_;
    return;
  }
  arrivals_.push_back(record);
}

void Recording::writeCsv(const std::filesystem::path& path, const Quat& q_WS) const {
  // The file has the columns of one object and one proxy even if the scene has none.
  const int objects = std::max(1, object_count_), proxies = std::max(1, proxy_count_);
  std::string text = "t,";
  for (const char* name : {"device", "device_v", "force"}) {
    if (std::string_view(name) == "device_v") {
      text += "device_vx,device_vy,device_vz,";
    } else {
      addVectorHeader(text, name);
    }
  }
  for (int i = 0; i < objects; ++i) addBodyHeader(text, "object", i);
  for (int i = 0; i < proxies; ++i) addBodyHeader(text, "proxy", i);
  text += "contact\n";

  const Quat q_SW = q_WS.conjugate();
  const BodyRecord nothing;
  const auto addBody = [&](Row& row, const BodyRecord& now, const BodyRecord& first) {
    row.add(Vec3(q_SW * (now.island.p_W - first.island.p_W)));
    row.add(Vec3(q_SW * (now.bullet.p_W - first.bullet.p_W)));
    row.add(Quat(q_SW * now.island.q_WB * first.island.q_WB.conjugate() * q_WS));
  };
  text.reserve(text.size() + ticks_.size() * 400);
  Row row(text);
  for (std::size_t t = 0; t < ticks_.size(); ++t) {
    const TickRecord& tick = ticks_[t];
    row.add(tick.time);
    row.add(Vec3(q_SW * (tick.device.hip.p_W - ticks_[0].device.hip.p_W)));
    row.add(Vec3(q_SW * tick.device.hip.v_W));
    row.add(Vec3(q_SW * tick.f_W));
    for (int i = 0; i < objects; ++i)
      addBody(row, i < object_count_ ? object(t, i) : nothing,
              i < object_count_ ? object(0, i) : nothing);
    for (int i = 0; i < proxies; ++i)
      addBody(row, i < proxy_count_ ? proxy(t, i) : nothing,
              i < proxy_count_ ? proxy(0, i) : nothing);
    row.add(tick.contact ? 1.0 : 0.0);
    row.end();
  }

  const std::filesystem::path unfinished = path.string() + ".tmp";
  std::ofstream file(unfinished, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(unfinished, path, error);
  if (!file || error) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw Error("cannot write " + path.string() + ": is the folder there, writable and not full?");
  }
}

}  // namespace tandem
