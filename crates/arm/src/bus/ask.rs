//! Asks until a servo answers, or has been asked often enough.

use super::{
    BusError, Cause, ServoBus, ServoError,
    exchange::{Answer, Question},
    register,
};

/// What came of a question to one servo.
pub(super) type Outcome = Result<Answer, ServoError>;

impl ServoBus {
    /// Asks one servo.
    pub(super) fn ask(
        &mut self,
        id: u8,
        question: &Question,
        asked: &str,
    ) -> Result<Answer, BusError> {
        check_id(id)?;
        let outcome = self.ask_all(&[id], question, asked)?.pop();
        Ok(outcome.ok_or(BusError::Nothing)??)
    }

    /// Asks servos at once, and those again that did not answer. The outcomes are in the order of the ids.
    pub(super) fn ask_all(
        &mut self,
        ids: &[u8],
        question: &Question,
        asked: &str,
    ) -> Result<Vec<Outcome>, BusError> {
        ids.iter().try_for_each(|id| check_id(*id))?;
        let mut outcomes: Vec<Option<Answer>> = vec![None; ids.len()];
        let mut causes = vec![Cause::NoAnswer; ids.len()];
        let mut tries = vec![0; ids.len()];
        for number in 0..self.retries.tries.max(1) {
            let left = self.left(ids, &outcomes, number);
            if left.is_empty() {
                break;
            }
            if number > 0 {
                self.statistics.retried += 1;
                if number > 1 {
                    self.free_receivers()?;
                }
                let until = self.wire.now() + self.retries.pause(number);
                self.listen_until(until)?;
            }
            let asked_now: Vec<u8> = left
                .iter()
                .filter_map(|place| ids.get(*place))
                .copied()
                .collect();
            let heard = self.exchange_in_order(question, &asked_now)?;
            for (place, answer) in left.into_iter().zip(heard) {
                if let Some(count) = tries.get_mut(place) {
                    *count += 1;
                }
                match (answer, outcomes.get_mut(place), causes.get_mut(place)) {
                    (Ok(answer), Some(outcome), _) => *outcome = Some(answer),
                    (Err(cause), _, Some(last)) => *last = cause,
                    _ => {}
                }
            }
        }
        let outcomes = outcomes
            .into_iter()
            .zip(ids)
            .zip(causes.into_iter().zip(tries));
        Ok(outcomes
            .map(|((answer, id), (cause, tries))| {
                answer.ok_or_else(|| self.give_up(*id, asked, tries, cause))
            })
            .collect())
    }

    /// Places of the servos that are to be asked. One that was silent before is asked once.
    fn left(&self, ids: &[u8], outcomes: &[Option<Answer>], number: u32) -> Vec<usize> {
        let each = ids.iter().zip(outcomes).enumerate();
        each.filter(|(_, (id, outcome))| {
            outcome.is_none() && (number == 0 || !self.silent.contains(id))
        })
        .map(|(place, _)| place)
        .collect()
    }

    /// Asks once. An acknowledgement has no length of its own, so a late one is flushed out by a read before.
    fn exchange_in_order(
        &mut self,
        question: &Question,
        ids: &[u8],
    ) -> Result<Vec<Result<Answer, Cause>>, BusError> {
        if let (Question::Do(..), [id]) = (question, ids)
            && self.unsettled.contains(id)
        {
            let id_register = Question::Read {
                address: register::ID.address(),
                size: register::ID.size(),
            };
            let heard = self.exchange(&id_register, ids)?.ok_or(BusError::TooLong)?;
            if heard.answers.iter().any(Option::is_none) {
                return Ok(vec![Err(heard.cause(*id, 1))]);
            }
        }
        let heard = self.exchange(question, ids)?.ok_or(BusError::TooLong)?;
        self.last_had_echo = heard.has_echo;
        let causes: Vec<Cause> = ids.iter().map(|id| heard.cause(*id, 0)).collect();
        let answers = heard.answers.into_iter().zip(causes);
        Ok(answers.map(|(answer, cause)| answer.ok_or(cause)).collect())
    }

    fn give_up(&mut self, id: u8, asked: &str, tries: u32, cause: Cause) -> ServoError {
        self.statistics.lost += 1;
        self.silent.insert(id);
        self.servo_error(id, asked, tries, cause)
    }

    pub(super) fn servo_error(&self, id: u8, asked: &str, tries: u32, cause: Cause) -> ServoError {
        ServoError {
            id,
            joint: self.names.get(&id).cloned(),
            asked: asked.to_owned(),
            tries,
            cause,
        }
    }
}

pub(super) fn check_id(id: u8) -> Result<(), BusError> {
    if id < super::frame::BROADCAST {
        Ok(())
    } else {
        Err(BusError::Id { id })
    }
}
