//! Who may look on: every program that reaches the address, and of pages in browsers those of this machine,
//! those of Foxglove and those that are named. Browsers say in `Origin` whose page it is; a page cannot
//! change that.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use tungstenite::http::Uri;
use tungstenite::http::uri::Authority;

/// Origins that are always welcome: Foxglove's own page, and its and its forks' desktop programs.
const FOXGLOVE: [&str; 2] = ["https://app.foxglove.dev", "file://"];

/// Where a drive is shown, and to whom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Endpoint {
    /// Where it is served.
    pub at: SocketAddr,
    /// Other pages that may look on, each as [`origin`] gives it.
    pub origins: Vec<String>,
}

/// `PORT` of this machine alone, or `ADDRESS:PORT`.
pub fn address(text: &str) -> Result<SocketAddr, String> {
    let loopback = |port| SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), port);
    let port = text.parse::<u16>().ok().map(loopback);
    port.or_else(|| text.parse().ok())
        .ok_or_else(|| "expected PORT, as in 8765, or ADDRESS:PORT, as in 0.0.0.0:8765 or [::1]:8765".into())
}

/// The origin of a page, as browsers write it: `http://NAME`, `http://NAME:PORT` or the same with `https`.
pub fn origin(text: &str) -> Result<String, String> {
    let expected = || "expected the page's scheme, host and port, as in http://rig.lab:8080".to_owned();
    let uri: Uri = text.parse().map_err(|_| expected())?;
    let (scheme, authority) = uri.scheme_str().zip(uri.authority()).ok_or_else(expected)?;
    let is_bare = uri.path() == "/" && uri.query().is_none() && !authority.as_str().contains('@');
    if !is_bare || text.ends_with('/') || !["http", "https"].contains(&scheme) {
        return Err(expected());
    }
    Ok(text.to_ascii_lowercase())
}

impl Endpoint {
    /// Why a request is refused; `None` when it is welcome. Both are headers, as they came.
    pub fn refusal(&self, host: Option<&[u8]>, origin: Option<&[u8]>) -> Option<String> {
        if let Some(origin) = origin.filter(|origin| !self.welcomes(origin)) {
            let origin = String::from_utf8_lossy(origin);
            return Some(format!("a page of {origin} may not look on without --foxglove-origin {origin}"));
        }
        // A name that an attacker makes point here is told by what the browser believes to talk to.
        let is_meant = |host: &[u8]| text(host).and_then(|host| host.parse().ok()).is_some_and(|a| is_local(&a));
        let host = host.filter(|host| self.at.ip().is_loopback() && !is_meant(host))?;
        let host = String::from_utf8_lossy(host);
        Some(format!("it was asked for as {host}; expected localhost or an address of this machine alone"))
    }

    fn welcomes(&self, origin: &[u8]) -> bool {
        let Some(origin) = text(origin).map(str::to_ascii_lowercase) else { return false };
        let is_named = || self.origins.contains(&origin) || FOXGLOVE.contains(&origin.as_str());
        is_named() || origin.parse::<Uri>().is_ok_and(|uri| uri.authority().is_some_and(is_local))
    }
}

fn text(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok()
}

/// Whether a host can only be this machine.
fn is_local(authority: &Authority) -> bool {
    let host = authority.host().trim_start_matches('[').trim_end_matches(']');
    let name = host.to_ascii_lowercase();
    let is_name = name == "localhost" || name.ends_with(".localhost");
    is_name || host.parse::<IpAddr>().is_ok_and(|ip| ip.to_canonical().is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(at: &str, host: &str, origin: Option<&str>) -> Option<String> {
        let endpoint = Endpoint { at: at.parse().unwrap(), origins: vec!["http://rig.lab:8080".into()] };
        endpoint.refusal(Some(host.as_bytes()), origin.map(str::as_bytes))
    }

    #[test]
    fn pages_of_this_machine_of_foxglove_and_those_that_are_named_look_on() {
        let welcome = [
            "http://localhost:8080",
            "http://127.0.0.1",
            "https://[::1]:3000",
            "http://lichtblick.localhost",
            "https://app.foxglove.dev",
            "file://",
            "HTTP://RIG.lab:8080",
        ];
        for origin in welcome {
            assert_eq!(refused("127.0.0.1:8765", "localhost:8765", Some(origin)), None, "{origin}");
        }
        let strange = [
            "https://evil.example",
            "http://rig.lab",
            "http://localhost.evil.example",
            "http://evil.example:8765",
            "https://app.foxglove.dev.evil.example",
            "https://app.foxglove.dev@evil.example",
            "null",
            "",
        ];
        for origin in strange {
            for at in ["127.0.0.1:8765", "0.0.0.0:8765"] {
                let said = refused(at, "localhost:8765", Some(origin)).unwrap_or_default();
                assert!(said.starts_with("a page of") && said.contains("--foxglove-origin"), "{origin}: {said}");
            }
        }
    }

    #[test]
    fn what_is_served_on_this_machine_alone_is_not_asked_for_by_another_name() {
        for host in ["localhost:8765", "127.0.0.1:8765", "127.0.0.1", "[::1]:8765", "[::ffff:127.0.0.1]:1"] {
            assert_eq!(refused("127.0.0.1:8765", host, None), None, "{host}");
        }
        for host in ["evil.example:8765", "localhost.evil.example", "10.0.0.1:8765", "", "a b"] {
            assert!(
                refused("[::1]:8765", host, None).is_some_and(|said| said.starts_with("it was asked for")),
                "{host}"
            );
            assert_eq!(refused("0.0.0.0:8765", host, None), None, "others may call it as they like");
        }
    }

    #[test]
    fn origins_are_written_as_browsers_write_them() {
        assert_eq!(origin("http://Rig.lab:8080"), Ok("http://rig.lab:8080".into()));
        assert_eq!(origin("https://10.0.0.7"), Ok("https://10.0.0.7".into()));
        for wrong in
            ["rig.lab", "http://", "http://rig.lab/", "http://rig.lab/page", "ftp://rig.lab", "http://u@h", "*"]
        {
            assert!(origin(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn addresses_are_of_this_machine_unless_said_otherwise() {
        assert_eq!(address("8765"), Ok("127.0.0.1:8765".parse().unwrap()));
        assert_eq!(address("[::1]:80"), Ok("[::1]:80".parse().unwrap()));
        assert!(address("all:80").is_err() && address("70000").is_err() && address("").is_err());
    }
}
