//! Tests TLS connections to a real PostgreSQL server, with certificates created by OpenSSL.

use super::server::{PostgresServer, set_owner_to_postgres};
use crate::records::database::Database;
use sqlx::Row;
use std::net::TcpListener;
use std::path::Path;
use std::process::Command;

const KEY_OPTIONS: &str = "-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes";
const TLS_INFO_QUERY: &str = "SELECT version, client_dn FROM pg_stat_ssl WHERE pid = pg_backend_pid() AND ssl";

fn openssl(folder: &Path, words: &str) {
    let done = Command::new("openssl").args(words.split(' ')).current_dir(folder).output().unwrap();
    assert!(done.status.success(), "openssl {words}: {}", String::from_utf8_lossy(&done.stderr));
}

/// Creates a certificate authority: `NAME.pem` and `NAME.key`.
fn create_authority(folder: &Path, name: &str) {
    openssl(folder, &format!("req -x509 {KEY_OPTIONS} -keyout {name}.key -out {name}.pem -days 2 -subj /CN={name}"));
}

/// Creates `NAME.pem` and `NAME.key` for a host, signed by the `ours` authority.
fn create_signed_certificate(folder: &Path, name: &str, host: &str) {
    std::fs::write(folder.join("more.cnf"), format!("subjectAltName=DNS:{host}\nbasicConstraints=CA:FALSE\n")).unwrap();
    openssl(folder, &format!("req {KEY_OPTIONS} -keyout {name}.key -out {name}.csr -subj /CN={name}"));
    let sign = "-CA ours.pem -CAkey ours.key -CAcreateserial -days 2 -extfile more.cnf";
    openssl(folder, &format!("x509 -req -in {name}.csr -out {name}.pem {sign}"));
}

/// Returns the TLS version and the client certificate's subject, as reported by PostgreSQL for this connection.
fn tls_info(url: &str) -> Option<(String, String)> {
    let database = Database::open(url).unwrap();
    let row = database.run(async { sqlx::query(TLS_INFO_QUERY).fetch_optional(&database.pool).await }).unwrap()?;
    Some((row.get(0), row.try_get(1).unwrap_or_default()))
}

#[test]
fn val_tls_options_in_postgresql_url_are_applied() {
    let made = tempfile::tempdir().unwrap();
    let folder = made.path();
    create_authority(folder, "ours");
    create_authority(folder, "other");
    create_signed_certificate(folder, "server", "localhost");
    create_signed_certificate(folder, "station", "station");
    set_owner_to_postgres(&folder.join("server.key"));
    // PostgreSQL runs as a different user and must be able to read the files.
    std::fs::set_permissions(folder, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
    let at = |name: &str| folder.join(name).display().to_string();
    let port = TcpListener::bind(("127.0.0.1", 0)).unwrap().local_addr().unwrap().port();
    let files = [("ssl_cert_file", "server.pem"), ("ssl_key_file", "server.key"), ("ssl_ca_file", "ours.pem")];
    let mut settings = vec!["ssl=on".to_owned()];
    settings.extend(files.map(|(name, file)| format!("{name}={}", at(file))));
    let _server = PostgresServer::start_on_port(port, &settings);

    let url = |host: &str, words: &str| format!("postgres://spandrel@{host}:{port}/postgres?{words}");
    let (ours, other) = (at("ours.pem"), at("other.pem"));
    assert_eq!(tls_info(&url("localhost", "sslmode=disable")), None);
    for words in ["sslmode=prefer", "sslmode=require"] {
        assert_eq!(tls_info(&url("127.0.0.1", words)).unwrap().0, "TLSv1.3", "{words}");
    }
    assert!(tls_info(&url("localhost", &format!("sslmode=verify-full&sslrootcert={ours}"))).is_some());
    let own = format!("sslmode=verify-full&sslrootcert={ours}&sslcert={}&sslkey={}", at("station.pem"), at("station.key"));
    assert!(tls_info(&url("localhost", &own)).unwrap().1.contains("station"), "the client certificate is sent");

    let refused = |host: &str, words: &str| Database::open(&url(host, words)).unwrap_err().to_string();
    let name = refused("127.0.0.1", &format!("sslmode=verify-full&sslrootcert={ours}"));
    assert!(name.contains("for another host name"), "{name}");
    for stranger in ["sslmode=verify-full".to_owned(), format!("sslmode=verify-full&sslrootcert={other}")] {
        let unknown = refused("localhost", &stranger);
        assert!(unknown.contains("sslrootcert=FILE"), "{unknown}");
    }
}

#[test]
fn val_sslmode_require_rejects_a_server_without_tls() {
    let server = PostgresServer::start();
    let error = Database::open(&format!("{}&sslmode=require", server.url())).unwrap_err().to_string();
    assert!(error.contains("ssl = on") && error.contains("sslmode=disable"), "{error}");
    assert!(Database::open(&format!("{}&sslmode=prefer", server.url())).is_ok());
}
