#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include "tandem/bullet_bridge/shapes.h"

#include "site/site_impl.h"

namespace tandem {

std::vector<ConfigurationItem> describeObjects(const std::vector<std::string>& names) {
  std::vector<ConfigurationItem> items;
  items.reserve(names.size());
  for (const std::string& name : names) {
    if (name.empty())
      throw std::invalid_argument("an object's name is empty; give it 1 to 57 characters");
    items.push_back({"object." + name, "shared"});
  }
  return makeConfiguration(std::move(items));
}

std::vector<ObjectId> Site::Impl::share(const std::vector<NamedBody>& named) {
  checkOpenToSetUp();
  if (!bodies.objects.empty())
    throw Error(
        "objects are shared already; share those with names in one call, before all others");
  if (named.size() > kMaxSharedObjects)
    throw Error("a site shares at most " + std::to_string(kMaxSharedObjects) + " objects");
  std::vector<std::string> names;
  names.reserve(named.size());
  for (const NamedBody& one : named) {
    if (!one.body) throw std::invalid_argument("object " + one.name + " has no body");
    checkShareable(*one.body);
    static_cast<void>(getShareableShape(*one.body));
    HapticBody::checkAttachable(host_world.world(), *one.body);
    host_step->checkObject(1.0 / static_cast<double>(one.body->getInvMass()) / settings.peers);
    for (const NamedBody& other : named)
      if (&other != &one && other.body == one.body)
        throw Error("objects " + other.name + " and " + one.name + " have the same body");
    names.push_back(one.name);
  }
  static_cast<void>(describeObjects(names));  // checks them

  std::vector<std::size_t> order(named.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return names[a] < names[b]; });
  std::vector<ObjectId> ids(named.size());
  for (const std::size_t i : order) ids[i] = share(*named[i].body, named[i].damping);
  return ids;
}

}  // namespace tandem
