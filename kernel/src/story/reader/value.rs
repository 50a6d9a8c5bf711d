//! Values of attributes: parameters (`$name`) and expressions (`${$name * 2 + 1}`), as OpenSCENARIO 1.1 has them.

/// Longest expression, characters, and how deep its brackets may go.
const LENGTH: usize = 1000;
const DEPTH: u32 = 30;

type OfOne = fn(f64) -> f64;
type OfTwo = fn(f64, f64) -> f64;

/// Functions of one value, and of two. Angles are radians.
const OF_ONE: [(&str, OfOne); 12] = [
    ("sqrt", libm::sqrt),
    ("floor", libm::floor),
    ("ceil", libm::ceil),
    ("round", libm::round),
    ("abs", f64::abs),
    ("sign", |value| if value == 0.0 { 0.0 } else { value.signum() }),
    ("sin", libm::sin),
    ("cos", libm::cos),
    ("tan", libm::tan),
    ("asin", libm::asin),
    ("acos", libm::acos),
    ("atan", libm::atan),
];
const OF_TWO: [(&str, OfTwo); 3] = [("pow", libm::pow), ("min", f64::min), ("max", f64::max)];

/// Finds a parameter's value by its name.
pub type Find<'a> = &'a dyn Fn(&str) -> Result<Option<String>, String>;

/// The value of an attribute; a parameter or expression in it must be all of it.
pub fn of(text: &str, find: Find<'_>) -> Result<String, String> {
    let Some(rest) = text.strip_prefix('$') else { return Ok(text.to_owned()) };
    if let Some(expression) = rest.strip_prefix('{').and_then(|rest| rest.strip_suffix('}')) {
        if expression.len() > LENGTH {
            return Err(format!("expected an expression of at most {LENGTH} characters"));
        }
        let mut terms = Terms { rest: expression, find };
        let value = terms.sum(0)?;
        terms.skip();
        return match terms.rest {
            "" if value.is_finite() => Ok(value.to_string()),
            "" => Err("it has no finite value".to_owned()),
            rest => Err(format!("expected an operator before {:?}", head(rest))),
        };
    }
    found(rest, find)
}

fn found(name: &str, find: Find<'_>) -> Result<String, String> {
    find(name)?.ok_or_else(|| format!("there is no parameter {}", head(name)))
}

fn head(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(40).collect()
}

/// The rest of an expression.
struct Terms<'a> {
    rest: &'a str,
    find: Find<'a>,
}

impl Terms<'_> {
    fn skip(&mut self) {
        self.rest = self.rest.trim_start();
    }

    /// Takes one of some characters.
    fn take(&mut self, among: &[char]) -> Option<char> {
        self.skip();
        let next = self.rest.chars().next().filter(|next| among.contains(next))?;
        self.rest = &self.rest[next.len_utf8()..];
        Some(next)
    }

    /// Takes characters as long as they are of a kind.
    fn run(&mut self, is_of_it: impl Fn(char) -> bool) -> &str {
        let end = self.rest.find(|c| !is_of_it(c)).unwrap_or(self.rest.len());
        let (run, rest) = self.rest.split_at(end);
        self.rest = rest;
        run
    }

    fn sum(&mut self, depth: u32) -> Result<f64, String> {
        let mut value = self.product(depth)?;
        while let Some(operator) = self.take(&['+', '-']) {
            let next = self.product(depth)?;
            value = if operator == '+' { value + next } else { value - next };
        }
        Ok(value)
    }

    fn product(&mut self, depth: u32) -> Result<f64, String> {
        let mut value = self.factor(depth)?;
        while let Some(operator) = self.take(&['*', '/', '%']) {
            let next = self.factor(depth)?;
            value = match operator {
                '*' => value * next,
                '/' => value / next,
                _ => value % next,
            };
        }
        Ok(value)
    }

    fn factor(&mut self, depth: u32) -> Result<f64, String> {
        if depth > DEPTH {
            return Err(format!("expected brackets at most {DEPTH} deep"));
        }
        if self.take(&['-']).is_some() {
            return Ok(-self.factor(depth + 1)?);
        }
        if self.take(&['(']).is_some() {
            let value = self.sum(depth + 1)?;
            return self.take(&[')']).map(|_| value).ok_or_else(|| "expected )".to_owned());
        }
        if self.take(&['$']).is_some() {
            let name = self.run(|c| c.is_alphanumeric() || c == '_').to_owned();
            let value = found(&name, self.find)?;
            return value.parse().map_err(|_| format!("parameter {} is no number", head(&name)));
        }
        self.skip();
        if self.rest.starts_with(char::is_alphabetic) {
            return self.function(depth);
        }
        let number = self.run(|c| c.is_ascii_digit() || c == '.').to_owned();
        number.parse().map_err(|_| format!("expected a number before {:?}", head(self.rest)))
    }

    fn function(&mut self, depth: u32) -> Result<f64, String> {
        let name = self.run(char::is_alphabetic).to_owned();
        if name == "pi" {
            return Ok(core::f64::consts::PI);
        }
        let open = self.take(&['(']).ok_or_else(|| format!("expected ( after {}", head(&name)));
        open?;
        let value = self.sum(depth + 1)?;
        if let Some((_, of_two)) = OF_TWO.iter().find(|(of, _)| *of == name) {
            self.take(&[',']).ok_or_else(|| format!("expected two values of {name}"))?;
            let second = self.sum(depth + 1)?;
            self.take(&[')']).ok_or("expected )")?;
            return Ok(of_two(value, second));
        }
        self.take(&[')']).ok_or("expected )")?;
        match OF_ONE.iter().find(|(of, _)| *of == name) {
            Some((_, of_one)) => Ok(of_one(value)),
            None => {
                let known = OF_ONE.iter().map(|(of, _)| *of).chain(OF_TWO.iter().map(|(of, _)| *of));
                Err(format!("expected one of {}, not {}", known.collect::<Vec<_>>().join(", "), head(&name)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<String, String> {
        let parameters = [("speed", "12.5"), ("name", "Ego"), ("n_2", "4")];
        of(text, &|name| Ok(parameters.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned())))
    }

    #[test]
    fn parameters_and_expressions_have_values() {
        for (text, expected) in [
            ("plain", "plain"),
            ("$name", "Ego"),
            ("$speed", "12.5"),
            ("${$speed * 2}", "25"),
            ("${ 1 + 2 * 3 - -4 }", "11"),
            ("${(1 + 2) * (3 - $n_2) / 2}", "-1.5"),
            ("${65 * pi / 180 - 65 / (180 / pi)}", "0"),
            ("${pow(2, 3) + min($speed, 1) + max(1, 2) * sign(-7) + cos(0) + acos(1)}", "8"),
            ("${7 % 4 + round(2.4) + sqrt(16) + abs(-3) + floor(1.9) + ceil(0.1)}", "14"),
        ] {
            assert_eq!(value(text).as_deref(), Ok(expected), "{text}");
        }
    }

    #[test]
    fn others_are_refused() {
        for (text, said) in [
            ("$speeed", "there is no parameter speeed"),
            ("${$name + 1}", "parameter name is no number"),
            ("${1 / 0}", "it has no finite value"),
            ("${1 +}", "expected a number before"),
            ("${1 1}", "expected an operator before"),
            ("${(1}", "expected )"),
            ("${log(1)}", "expected one of sqrt, floor,"),
            ("${pow(1)}", "expected two values of pow"),
        ] {
            let refused = value(text).expect_err(text);
            assert!(refused.starts_with(said), "{text}: {refused}");
        }
        let deep = format!("${{{}1{}}}", "(".repeat(400), ")".repeat(400));
        assert!(value(&deep).is_err_and(|why| why.contains("deep")));
        assert!(value(&format!("${{{}1}}", "-".repeat(900))).is_err());
    }
}
