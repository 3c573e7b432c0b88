//! Password hashing with argon2id and the parameters that OWASP recommends (19 MiB, 2 passes, 1 lane), which are the
//! library's defaults.

use crate::errors::AppError;
use argon2::password_hash::phc::{Output, PasswordHash, Salt};
use argon2::{ARGON2ID_IDENT, Algorithm, Argon2, Block, Params, Version};

/// Hash to verify for names without a password, so that the response takes as long as for names with a password.
const DUMMY_HASH: &str = "$argon2id$v=19$m=19456,t=2,p=1$c3BhbmRyZWxzcGFuZHJlbA$lpYT1oVDUN5U6kPGGjEw5xOVQbQTkgO2xbCVrTQEzDM";
/// Maximum memory cost of a stored hash, KiB. It prevents an untrusted database from exhausting the memory. Estimate:
/// about three times the default.
const MAX_MEMORY_KIB: u32 = 65_536;
/// Maximum number of passes for a stored hash, to limit the CPU time (estimate).
const MAX_PASSES: u32 = 10;

/// Working memory for hashing, allocated once and reused.
#[derive(Debug, Default)]
pub struct HashingMemory(Vec<Block>);

impl HashingMemory {
    fn hash_into(&mut self, argon2: &Argon2<'_>, password: &str, salt: &[u8], out: &mut [u8]) -> argon2::Result<()> {
        let needed = argon2.params().block_count();
        if self.0.len() < needed {
            self.0.resize(needed, Block::default());
        }
        argon2.hash_password_into_with_memory(password.as_bytes(), salt, out, &mut self.0[..needed])
    }
}

/// Returns the password's hash in PHC string format.
///
/// # Errors
/// Returns an error if the system's random number generator fails.
pub fn hash(password: &str, memory: &mut HashingMemory) -> Result<String, AppError> {
    let failed = |error: &dyn std::fmt::Display| AppError::failed(format!("cannot hash the password: {error}"));
    let mut salt = [0; 16];
    getrandom::fill(&mut salt).map_err(|error| failed(&error))?;
    let argon2 = Argon2::default();
    let mut out = [0; Params::DEFAULT_OUTPUT_LEN];
    memory.hash_into(&argon2, password, &salt, &mut out).map_err(|error| failed(&error))?;
    let params = argon2.params().try_into().map_err(|error: argon2::password_hash::Error| failed(&error))?;
    let parsed = PasswordHash {
        algorithm: ARGON2ID_IDENT,
        version: Some(Version::V0x13.into()),
        params,
        salt: Some(Salt::new(&salt).map_err(|error| failed(&error))?),
        hash: Some(Output::new(&out).map_err(|error| failed(&error))?),
    };
    Ok(parsed.to_string())
}

/// Returns true if the password matches the hash. If there is no hash, takes the same time and returns false.
pub fn verify(password: &str, hash: Option<&str>, memory: &mut HashingMemory) -> bool {
    let stored = PasswordHash::new(hash.unwrap_or(DUMMY_HASH));
    let fits = stored.ok().and_then(|stored| matches(password, &stored, memory)).unwrap_or(false);
    fits && hash.is_some()
}

/// Computes the hash and compares it. Returns `None` for a hash that is not supported or too costly.
fn matches(password: &str, stored: &PasswordHash, memory: &mut HashingMemory) -> Option<bool> {
    let params = Params::try_from(stored).ok().filter(|p| p.m_cost() <= MAX_MEMORY_KIB && p.t_cost() <= MAX_PASSES)?;
    let algorithm = Algorithm::try_from(stored.algorithm.as_str()).ok()?;
    let version = stored.version.map_or(Ok(Version::default()), Version::try_from).ok()?;
    let expected = stored.hash?;
    let salt = stored.salt?;
    let mut out = [0; Output::MAX_LENGTH];
    let out = out.get_mut(..expected.len())?;
    memory.hash_into(&Argon2::new(algorithm, version, params), password, &salt, out).ok()?;
    // `Output` values are compared in constant time.
    Some(Output::new(out).ok()? == expected)
}

#[cfg(test)]
mod tests {
    use super::*;
    use argon2::password_hash::{PasswordHasher, PasswordVerifier};

    #[test]
    fn exact_hashes_match_only_their_password_and_are_salted() {
        let memory = &mut HashingMemory::default();
        let first = hash("correct horse battery", memory).unwrap();
        assert!(first.starts_with("$argon2id$v=19$m=19456,t=2,p=1$"), "{first}");
        assert_ne!(first, hash("correct horse battery", memory).unwrap());
        assert!(verify("correct horse battery", Some(&first), memory));
        assert!(!verify("correct horse batterz", Some(&first), memory));
        assert!(!verify("correct horse battery", None, memory));
        assert!(!verify("x", Some("no hash"), memory));
        // The dummy hash must be valid, so that the response time does not reveal whether a name exists.
        assert!(PasswordHash::new(DUMMY_HASH).is_ok());
    }

    #[test]
    fn val_hashes_agree_with_the_library_verifier() {
        let memory = &mut HashingMemory::default();
        let ours = hash("correct horse battery", memory).unwrap();
        let parsed = PasswordHash::new(&ours).unwrap();
        assert!(Argon2::default().verify_password(b"correct horse battery", &parsed).is_ok());
        // A hash with different cost parameters, as in older databases.
        let other = Argon2::new(Algorithm::Argon2id, Version::V0x13, Params::new(8_192, 3, 2, None).unwrap());
        let theirs = other.hash_password_with_salt(b"correct horse battery", &[7; 16]).unwrap().to_string();
        assert!(verify("correct horse battery", Some(&theirs), memory) && !verify("another", Some(&theirs), memory));
        let greedy = theirs.replace("m=8192", "m=4194304");
        assert!(!verify("correct horse battery", Some(&greedy), memory));
        assert!(memory.0.len() <= MAX_MEMORY_KIB as usize);
    }
}
