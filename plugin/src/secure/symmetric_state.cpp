#include "secure/symmetric_state.h"

#include <algorithm>

#include "coordination/src/wire/wire_sealing.h"

namespace tandem::secure {

void SymmetricState::start(ByteView protocol_name) noexcept {
  hash.fill(0);
  std::copy(protocol_name.begin(), protocol_name.end(), hash.begin());
  chaining_key = hash;
  key.fill(0);
  nonce = 0;
}

void SymmetricState::mixHash(ByteView data) noexcept {
  crypto_generichash_state state;
  crypto_generichash_init(&state, nullptr, 0, kHashSize);
  crypto_generichash_update(&state, hash.data(), hash.size());
  crypto_generichash_update(&state, data.data(), data.size());
  crypto_generichash_final(&state, hash.data(), hash.size());
  sodium_memzero(&state, sizeof state);  // it may contain key material
}

void SymmetricState::mixKey(ByteView input) noexcept {
  WipedBytes<kHashSize> new_key;
  computeHkdf(chaining_key, input, chaining_key, new_key);
  std::copy_n(new_key.begin(), kKeySize, key.begin());
  nonce = 0;
}

void SymmetricState::mixKeyAndHash(ByteView input) noexcept {
  WipedBytes<kHashSize> to_hash, new_key;
  computeHkdf(chaining_key, input, chaining_key, to_hash, new_key);
  mixHash(to_hash);
  std::copy_n(new_key.begin(), kKeySize, key.begin());
  nonce = 0;
}

void SymmetricState::encryptAndHash(ByteView text, Bytes sealed) noexcept {
  crypto_aead_chacha20poly1305_ietf_encrypt(sealed.data(), nullptr, text.data(), text.size(),
                                            hash.data(), hash.size(), nullptr,
                                            writeNonce(0, nonce).data(), key.data());
  ++nonce;
  mixHash(sealed);
}

bool SymmetricState::decryptAndHash(ByteView sealed, Bytes text) noexcept {
  if (crypto_aead_chacha20poly1305_ietf_decrypt(text.data(), nullptr, nullptr, sealed.data(),
                                                sealed.size(), hash.data(), hash.size(),
                                                writeNonce(0, nonce).data(), key.data()) != 0)
    return false;
  ++nonce;
  mixHash(sealed);
  return true;
}

}  // namespace tandem::secure
